// One image of the pyramid, and its gradient, as the sampling kernels read them.
#pragma once
#include <cstdint>

#include "kernels/ring.h"

namespace plc {

// Values in [0,1], x fastest. A point p of mesh space lies at voxel coordinate
// scale * p + offset on each axis (voxel centres at integers), clamped to the image: outside, the
// border voxels are replicated (paper, 4.2). No coordinate makes a kernel read outside the image: a
// NaN counts as the image's lower border.
struct ImageView {
  const float* data = nullptr;
  int32_t dims[3] = {0, 0, 0};  // each >= 2; the product is below 2^31
  float scale[3] = {1, 1, 1};
  float offset[3] = {0, 0, 0};
};

// A vector per voxel, by the same rules of place; w is not read.
struct GradientView {
  const Packed* data = nullptr;
  int32_t dims[3] = {0, 0, 0};  // each >= 2; the product is below 2^31
  float scale[3] = {1, 1, 1};
  float offset[3] = {0, 0, 0};
};

}  // namespace plc
