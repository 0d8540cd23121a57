#include "engine/recover/progress_estimate.h"

#include <algorithm>
#include <cmath>

#include "engine/base/constants.h"

namespace plc {

namespace {

// What a transformation takes, with the looks around it, in movements of a vertex.
constexpr double kTransformation = 20;
// A level against the next coarser one: three times the vertices, and a few more iterations.
constexpr double kGrowth = 4;
// A round after late bubbles against the one before it. Nobody knows whether there will be one:
// this is wrong by less than two if there is, and if there is not. The less likely the nearer the
// energy is to epsilon: all of it from so many epsilon on.
constexpr double kAgain = 0.7, kRestless = 4;
// Rates and energies are averaged over so many iterations, a quarter of the round while it is
// young.
constexpr double kRecent = 8, kYoung = 4;
// What is left of a round is at least and at most this part of what it has taken, whatever the
// energy tells: an energy that stays where it is may fall below epsilon by chance at any time.
constexpr double kLeast = 0.15, kMost = 1;
// A round takes at least this part of what the one before it took.
constexpr double kOfBefore = 0.5;

// Of the last iteration in a mean.
double share_of(int iterations) {
  return std::clamp(kYoung / iterations, 1 / kRecent, 1.0);
}

double work_of(const OperationCounts& c) {
  return static_cast<double>(c.moves) +
         kTransformation *
             static_cast<double>(c.creation + c.inversion + c.deletion + c.annular + c.axial);
}

}  // namespace

void ProgressEstimate::start_level() {
  earlier_work_ += work_;
  work_ = 0;
}

void ProgressEstimate::start_round() {
  before_ = iterations_;
  iterations_ = 0;
}

void ProgressEstimate::observe(double work, double energy) {
  ++iterations_;
  const double share = share_of(iterations_);
  const double log_energy = std::log(std::max(energy, 1e-30));
  rate_ += (work - rate_) * share;
  recent_ += (log_energy - recent_) * share;
  past_ += (log_energy - past_) * std::min(1.0, 2.0 / iterations_);
}

// Where the energy falls like iterations^-p, the mean of its logarithm over the round, weighted by
// the iteration, lies p / 2 above that of now; and that of the last ones by p for each round that
// they lie back.
double ProgressEstimate::round_left(const Ahead& ahead) const {
  if (ahead.calm) return 0;
  double left = 0;
  const double back = (1 / share_of(iterations_) - 1) / iterations_;
  const double power = 2 * (past_ - recent_) / (1 - 2 * back);
  const double now = recent_ - std::max(power, 0.0) * back;
  if (now > 0) {
    const double longest =
        std::max(kMost * iterations_, static_cast<double>(before_ - iterations_));
    left = power > 0 ? iterations_ * std::expm1(std::min(now / power, 20.0)) : longest;
    left = std::clamp(left, kLeast * iterations_, longest);
  }
  left = std::max(left, kOfBefore * before_ - iterations_);
  if (left >= ahead.iterations) return ahead.iterations * rate_;
  // Before it ends all are awake for a while.
  return left * rate_ + kConfirmIterations * std::max(0.0, ahead.vertices - rate_);
}

double ProgressEstimate::add(const OperationCounts& level, double energy, const Ahead& ahead) {
  const double so_far = work_of(level);
  observe(so_far - work_, energy);
  work_ = so_far;
  const double rest = round_left(ahead);
  double left = rest;
  double of_level = work_ + rest;
  for (int h = 0; h < ahead.finer_levels; ++h) {
    of_level *= kGrowth;
    left += of_level;
  }
  if (ahead.again && (ahead.finer_levels > 0 || recent_ < std::log(kLateEnergy))) {
    left += kAgain * std::clamp(recent_ / std::log(kRestless), 0.0, 1.0) * of_level;
  }
  const double done = earlier_work_ + work_;
  return done > 0 ? done / (done + left) : 0;
}

}  // namespace plc
