#include "pyramid/taps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace plc {

namespace {

// The five points reach over at most 4 voxels, each touches 2; one more for a point that rounding
// puts on the next voxel with weight 0.
constexpr int64_t kReach = kernels::kMaxTaps + 1;

struct OutputTaps {
  int64_t first = 0;
  int64_t count = 0;  // up to the last weight that is not 0
  std::array<double, kReach> weights{};
};

OutputTaps taps_at(double centre, double spread, int64_t inputs) {
  const auto inside = [inputs](int64_t i) { return std::clamp<int64_t>(i, 0, inputs - 1); };
  OutputTaps result;
  result.first = inside(static_cast<int64_t>(std::floor(centre - 2.0 * spread)));
  for (int m = -2; m <= 2; ++m) {
    const double at = centre + m * spread;
    const double below = std::floor(at);
    const double weight = kKernel[m + 2] / kKernelSum;
    const auto i = static_cast<int64_t>(below);
    const auto add = [&](int64_t voxel, double w) {
      result.weights[static_cast<size_t>(inside(voxel) - result.first)] += w;
    };
    add(i, weight * (1.0 - (at - below)));
    if (at > below) add(i + 1, weight * (at - below));
  }
  for (int64_t k = 0; k < kReach; ++k) {
    if (result.weights[static_cast<size_t>(k)] > 0.0) result.count = k + 1;
  }
  return result;
}

}  // namespace

AxisTaps make_axis_taps(int64_t inputs, int64_t outputs, double spread) {
  const double ratio = static_cast<double>(inputs) / static_cast<double>(outputs);
  std::vector<OutputTaps> all;
  all.reserve(static_cast<size_t>(outputs));
  int64_t taps = 1;
  for (int64_t i = 0; i < outputs; ++i) {
    all.push_back(taps_at((static_cast<double>(i) + 0.5) * ratio - 0.5, spread, inputs));
    taps = std::max(taps, all.back().count);
  }
  AxisTaps result;
  result.taps = static_cast<int32_t>(taps);
  result.weights.reserve(static_cast<size_t>(outputs * taps));
  for (const OutputTaps& one : all) {
    // Near the far border the window slides back into the image; what it then covers in front
    // weighs 0.
    const int64_t first = std::min(one.first, inputs - taps);
    result.first.push_back(static_cast<int32_t>(first));
    for (int64_t k = 0; k < taps; ++k) {
      const int64_t own = first + k - one.first;
      const bool used = own >= 0 && own < one.count;
      result.weights.push_back(used ? static_cast<float>(one.weights[static_cast<size_t>(own)])
                                    : 0.0F);
    }
  }
  return result;
}

}  // namespace plc
