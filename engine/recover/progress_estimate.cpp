#include "engine/recover/progress_estimate.h"

#include <algorithm>
#include <cmath>

#include "engine/base/constants.h"

namespace plc {

namespace {

// What a transformation takes, with the looks around it, and what an iteration takes for a vertex
// that may sleep, in movements of a vertex: least squares over the iterations of 14 runs on real
// and noisy images, of one thread.
constexpr double kTransformation = 70, kVertex = 0.15;
// What comes before a round - refinement, search for late bubbles, their surfaces - takes as long
// as its transformations once more.
constexpr double kBeforeRound = 2;
// A level against the next coarser one: three times the vertices, and a few more iterations.
constexpr double kGrowth = 4;
// Late bubbles of the last level and a round for them, as a part of the level.
constexpr double kAgain = 0.1;
// Rates and energies are averaged over so many iterations, a quarter of the round while it is
// young.
constexpr double kRecent = 8, kYoung = 4;
// The energy of a round falls like its iterations to minus this.
constexpr double kPower = 1.3;
// What is left of a round is at least this part of what it has taken, and at most so many times
// that or what the one before it took: an energy that stays where it is, as where fronts are on
// their way, may fall at any time.
constexpr double kLeast = 0.12, kMost = 4;
// A round takes at least this part of what the one before it took, and while it is young as much:
// from rest its energy rises first.
constexpr double kLeastOfBefore = 0.5;
// Its iterations become cheaper, the last of many by this part.
constexpr double kCheaper = 0.3, kMany = 4;

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
  work_ += moved + (first ? kBeforeRound : 1) * changed;
  const double share = share_of(iterations_);
  rate_ += ((first ? moved : moved + changed) - rate_) * share;
  recent_ += (std::log(std::max(energy, 1e-30)) - recent_) * share;
}

double ProgressEstimate::round_left(const Ahead& ahead) const {
  if (ahead.calm) return 0;
  const double took = iterations_;
  // The mean of the energy's logarithm lies above that of now by the power for each round that it
  // lies back.
  const double now = recent_ / kPower - (1 / share_of(iterations_) - 1) / took;
  double left = took * std::expm1(std::clamp(now, 0.0, 20.0));
  left = std::min(left, kMost * std::max(took, 1.0 * before_));
  const double least = (took < kRecent ? 1 : kLeastOfBefore) * before_;
  left = ahead.late ? std::min(left, 1.0 * kMinIterations) : std::max(left, least - took);
  left = std::max({left, kLeast * took, kMinIterations - took});
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
