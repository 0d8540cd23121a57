// The points of eq. (12) along one axis, as weights on voxels.
#pragma once
#include <cstdint>
#include <vector>

#include "kernels/separable.h"

namespace plc {

// The kernel of (9) and (12) on one axis, in sixteenths.
inline constexpr double kKernel[5] = {1.0, 4.0, 6.0, 4.0, 1.0};
inline constexpr double kKernelSum = 16.0;

// Output i of an axis is the sum of weights[i * taps + k] * input[first[i] + k], k < taps.
// first[] never decreases; first[i] + taps <= inputs.
struct AxisTaps {
  std::vector<int32_t> first;
  std::vector<float> weights;
  int32_t taps = 0;

  kernels::TapsView view() const { return {first.data(), weights.data(), taps}; }
};

// From `inputs` voxels to `outputs` voxels of the same real extent (10). `spread` is U_h in voxels
// of the input, 0 < spread <= 1: the distance between the five points of the kernel, which are
// interpolated linearly; outside the image the border voxel is replicated. So a voxel's weights are
// those of five hat functions, computed in double and rounded once.
AxisTaps make_axis_taps(int64_t inputs, int64_t outputs, double spread);

}  // namespace plc
