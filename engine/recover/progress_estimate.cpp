#include "engine/recover/progress_estimate.h"

#include <algorithm>
#include <cmath>

#include "engine/base/constants.h"

namespace plc {

namespace {

// Constants are fitted to 24 runs of one thread on real images, uniform, adaptive and direct, where
// nothing else is said.
//
// The unit of work is the movement of one vertex. A transformation, with all the checks around it,
// takes kTransformation of it, and every vertex, asleep or not, kVertex in each iteration.
constexpr double kTransformation = 200, kVertex = 0.3;
// The transformations of a round's first iteration count so many times: what comes before the round
// - refinement, the search for late bubbles, their surfaces - takes nearly as long as they do.
constexpr double kBeforeRound = 1.7;
// ... and of an adaptive mesh, most of which only make edges shorter, so many; this and at_start()
// are fitted to three runs.
constexpr double kBeforeSizedRound = 0.4;
// So many times the work of a level is that of the next finer one, which has three times the
// vertices and takes a few more iterations.
constexpr double kGrowth = 4;
// The work of the last level's late bubbles and of the round for them, as a part of the level's.
constexpr double kAgain = 0.15;
// Rates and energies are averaged over the last kRecent iterations, or over the last 1 / kYoung of
// the round while that is less.
constexpr double kRecent = 30, kYoung = 2.5;
// At most so many times the iterations that the round, or the one before it, has taken are left.
constexpr double kMost = 10;
// In the first round of a run fronts are on their way, and how far they have to go the energy does
// not tell: the round is taken to be half over, and to last so many iterations more at least.
constexpr double kFronts = 100;
// Iterations become cheaper as a round goes on: where kMany times those that it has taken are still
// to come, by kCheaper in the mean.
constexpr double kCheaper = 0.75, kMany = 15;

// The weight of the last iteration in a running mean.
double share_of(int iterations) {
  return std::clamp(kYoung / iterations, 1 / kRecent, 1.0);
}

}  // namespace

void ProgressEstimate::start_level() {
  earlier_work_ += work_;
  work_ = 0;
  moves_ = operations_ = 0;
}

// Of seven images the iso-surface was thinned out and brought to its sizes in 6 parts, of one in 8,
// the first ones the longest, in a quarter to four tenths of all the time.
double ProgressEstimate::at_start(int parts) {
  constexpr double kMostOfAll = 0.5, kHalfOfIt = 3;
  return kMostOfAll * parts / (parts + kHalfOfIt);
}

// Of eight images what comes before anything moves took as long as 7 to 12 movements of a vertex,
// for each, however many transformations it needed. Bubbles need none, and take no time.
void ProgressEstimate::add_start(const OperationCounts& level, uint32_t vertices) {
  constexpr double kOfStart = 9.5;
  operations_ = level.transformations();
  if (operations_ != 0) work_ += kOfStart * vertices;
}

void ProgressEstimate::start_round() {
  before_ = iterations_;
  iterations_ = 0;
}

void ProgressEstimate::observe(const OperationCounts& level, double energy, const Ahead& ahead) {
  ++iterations_;
  const bool first = iterations_ == 1;
  const double moved = static_cast<double>(level.moves - moves_) + kVertex * ahead.vertices;
  const double changed =
      kTransformation * static_cast<double>(level.transformations() - operations_);
  moves_ = level.moves;
  operations_ = level.transformations();
  const double times = !first ? 1 : ahead.sized ? kBeforeSizedRound : kBeforeRound;
  // The very first iteration makes the mesh of the start even: it tells nothing of the others.
  if (!(first && first_round())) work_ += moved + times * changed;
  const double share = share_of(iterations_);
  rate_ += ((first ? moved : moved + changed) - rate_) * share;
  recent_ += (std::log(std::max(energy, 1e-30)) - recent_) * share;
}

double ProgressEstimate::round_left(const Ahead& ahead) const {
  if (ahead.calm) return 0;
  const double took = iterations_;
  // The energy falls like one over the iterations. recent_ is a mean over some of them, so it lies
  // above the logarithm of the energy now: an iteration lowers that by 1 / took, and the mean lies
  // 1 / share - 1 iterations back.
  const double now = recent_ - (1 / share_of(iterations_) - 1) / took;
  double left = took * std::expm1(std::clamp(now, 0.0, 20.0));
  left = std::min(left,
                  first_round() ? std::max(took, kFronts) : kMost * std::max(took, 1.0 * before_));
  if (ahead.late) left = std::min(left, 1.0 * kMinIterations);
  left = std::max(left, kMinIterations - took);
  if (left >= ahead.iterations) return ahead.iterations * rate_;
  // Before the round ends every vertex is awake for kConfirmIterations.
  return left * rate_ * (1 - kCheaper * std::min(1.0, left / (kMany * took))) +
         kConfirmIterations * std::max(0.0, ahead.vertices - rate_);
}

double ProgressEstimate::add(const OperationCounts& level, double energy, const Ahead& ahead) {
  observe(level, energy, ahead);
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
