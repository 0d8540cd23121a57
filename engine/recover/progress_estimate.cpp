#include "engine/recover/progress_estimate.h"

#include <algorithm>
#include <cmath>

#include "engine/base/constants.h"

namespace plc {

namespace {

// All constants: fitted to 24 runs of one thread on real images, uniform, adaptive and direct.
//
// What a transformation takes, with the looks around it, and what an iteration takes for a vertex
// that may sleep, in movements of a vertex.
constexpr double kTransformation = 200, kVertex = 0.3;
// What comes before a round - refinement, search for late bubbles, their surfaces - takes this part
// of its transformations once more.
constexpr double kBeforeRound = 1.7;
// A level against the next coarser one: three times the vertices, and a few more iterations.
constexpr double kGrowth = 4;
// Late bubbles of the last level and a round for them, as a part of the level.
constexpr double kAgain = 0.15;
// Rates and energies are averaged over so many iterations, less of them while the round is young:
// then the last one counts for kYoung of all.
constexpr double kRecent = 30, kYoung = 2.5;
// At most so many times what the round, or the one before it, has taken is left.
constexpr double kMost = 10;
// The first round: fronts are on their way, and how far that is the energy does not tell. Half of
// it is taken to be left, and of so many iterations at least.
constexpr double kFronts = 100;
// Iterations become cheaper, the last of many by this part.
constexpr double kCheaper = 0.75, kMany = 15;

// Of the last iteration in a mean.
double share_of(int iterations) {
  return std::clamp(kYoung / iterations, 1 / kRecent, 1.0);
}

}  // namespace

void ProgressEstimate::start_level() {
  earlier_work_ += work_;
  work_ = 0;
  moves_ = operations_ = 0;
}

void ProgressEstimate::start_round() {
  before_ = iterations_;
  iterations_ = 0;
}

void ProgressEstimate::observe(const OperationCounts& level, double energy, double vertices) {
  ++iterations_;
  const bool first = iterations_ == 1;
  const double moved = static_cast<double>(level.moves - moves_) + kVertex * vertices;
  const double changed =
      kTransformation * static_cast<double>(level.transformations() - operations_);
  moves_ = level.moves;
  operations_ = level.transformations();
  // The very first iteration makes the mesh of the start even: it tells nothing of the others.
  if (!(first && first_round())) work_ += moved + (first ? kBeforeRound : 1) * changed;
  const double share = share_of(iterations_);
  rate_ += ((first ? moved : moved + changed) - rate_) * share;
  recent_ += (std::log(std::max(energy, 1e-30)) - recent_) * share;
}

double ProgressEstimate::round_left(const Ahead& ahead) const {
  if (ahead.calm) return 0;
  const double took = iterations_;
  // The energy falls like one over the iterations. The mean of its logarithm lies above that of now
  // by the part of a round that it lies back.
  const double now = recent_ - (1 / share_of(iterations_) - 1) / took;
  double left = took * std::expm1(std::clamp(now, 0.0, 20.0));
  left = std::min(left,
                  first_round() ? std::max(took, kFronts) : kMost * std::max(took, 1.0 * before_));
  if (ahead.late) left = std::min(left, 1.0 * kMinIterations);
  left = std::max(left, kMinIterations - took);
  if (left >= ahead.iterations) return ahead.iterations * rate_;
  // Before it ends all are awake for a while.
  return left * rate_ * (1 - kCheaper * std::min(1.0, left / (kMany * took))) +
         kConfirmIterations * std::max(0.0, ahead.vertices - rate_);
}

double ProgressEstimate::add(const OperationCounts& level, double energy, const Ahead& ahead) {
  observe(level, energy, ahead.vertices);
  const double rest = round_left(ahead);
  double left = rest;
  double of_level = work_ + rest;
  for (int h = 0; h < ahead.finer_levels; ++h) {
    of_level *= kGrowth;
    left += of_level;
  }
  if (ahead.again) left += kAgain * of_level;
  const double done = earlier_work_ + work_;
  return done > 0 ? done / (done + left) : 0;
}

}  // namespace plc
