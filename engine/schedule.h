// Threads: parallel loops and the task graph of a step. The only file pair that names oneTBB.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pyramid/executor.h"

namespace plc {

// What passes read and write, one bit each.
enum Resource : uint32_t {
  kRings = 1U << 0,
  kPositions = 1U << 1,
  kVelocities = 1U << 2,
  kNormals = 1U << 3,
  kRestLength = 1U << 4,
  kLaplacians = 1U << 5,
  kStages = 1U << 6,  // force, stage position and velocity, sums of Runge-Kutta
  kDisplacements = 1U << 7,
  kEnergy = 1U << 8,
  kUserForce = 1U << 9,
};

// One row of the table of passes. Passes keep their order where one writes what the other reads or
// writes; where not, they may run at the same time.
struct Pass {
  std::string name;
  uint32_t reads;
  uint32_t writes;
  double* seconds;  // where the time of the pass is added; not null, may be shared
  std::function<void()> body;
};

// Of the passes that have just ended: their names, with ", " between those that may run at the same
// time.
using PassEnd = std::function<void(const std::string& names)>;

// The worker threads of one context. Loops and graphs run in an arena of their own.
class Schedule final : public Executor {
 public:
  // threads >= 1.
  explicit Schedule(int threads);
  ~Schedule() override;
  int threads() const { return threads_; }

  // With one thread, or one task, on the calling thread.
  void run(size_t tasks, const std::function<void(size_t)>& body) const override;
  // Runs the table. `small`: in order, on the calling thread. `after`, which may be empty, is
  // called at the same places of the table for any number of threads, while no pass runs.
  void run_passes(const std::vector<Pass>& passes, bool small, const PassEnd& after = {}) const;

 private:
  struct Arena;
  std::unique_ptr<Arena> arena_;
  int threads_;
};

// Seconds of a monotonic clock.
double now();

}  // namespace plc
