// How much of a recovery is done: an estimate from what it has cost so far.
#pragma once
#include <cstdint>

#include "engine/base/statistics.h"

namespace plc {

// In units of work, not of time: movements of single vertices, and transformations as so many. What
// is left of a round of iterations (recovery.h) is seen in its energy, which falls like about one
// over the iterations on every image that was tried; the finer levels cost more than the one before
// them by a constant factor. Everything is counted, so that the estimate is the same for
// any number of threads.
class ProgressEstimate {
 public:
  // What is known of the rest.
  struct Ahead {
    int iterations = 0;    // that the round may take at most
    double vertices = 0;   // all, asleep or not
    int finer_levels = 0;  // after this one
    bool again = false;    // the last level may get late bubbles, and a round for them
    bool late = false;     // the round is one for them
    bool calm = false;     // the round ends here
    bool sized = false;    // the mesh is adaptive
  };

  void start_level();
  // What making the surface that the level starts from has counted, and its vertices. Until then
  // at_start() tells how much of everything is done, after so many parts of it, where this is the
  // only level.
  void add_start(const OperationCounts& level, uint32_t vertices);
  static double at_start(int parts);
  void start_round();
  // An iteration: what the level has counted up to now, its energy in epsilon. Returns how much of
  // everything is done, 0 .. 1; it may fall.
  double add(const OperationCounts& level, double energy, const Ahead& ahead);

  // visit(field) for every field, in this order.
  template <typename Estimate, typename Visit>
  static void visit_fields(Estimate& e, const Visit& visit) {
    for (auto* n : {&e.iterations_, &e.before_}) visit(*n);
    for (auto* n : {&e.moves_, &e.operations_}) visit(*n);
    for (auto* x : {&e.earlier_work_, &e.work_, &e.rate_, &e.recent_}) visit(*x);
  }

 private:
  bool first_round() const { return before_ == 0; }
  void observe(const OperationCounts& level, double energy, const Ahead& ahead);
  double round_left(const Ahead& ahead) const;

  int iterations_ = 0;       // of the round
  int before_ = 0;           // of the round before; 0: there was none
  int64_t moves_ = 0;        // of the level, up to the last iteration
  int64_t operations_ = 0;   // ...
  double earlier_work_ = 0;  // of the levels before
  double work_ = 0;          // of the level
  double rate_ = 0;          // work per iteration, of the last ones
  double recent_ = 0;        // logarithm of the energy in epsilon, mean of the last iterations
};

}  // namespace plc
