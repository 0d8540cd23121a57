// One level of the pyramid from the level below (paper, 4.2, eq. (12), appendix A).
#pragma once
#include <array>
#include <cstdint>

#include "kernels/image.h"
#include "pyramid/executor.h"
#include "pyramid/taps.h"

namespace plc {

// X, then Y, then Z, as appendix A, but tile by tile of the output: a tile keeps a rolling window
// of input planes reduced along X and Y, so that the appendix's images G and H never exist whole.
// Every value is computed by the same operations whatever the tiles. Voxels in a type of their own
// are read as they stand, a few rows at a time. Returns false when a tile's scratch memory could
// not be had.
bool reduce_image(const ImageView& in, const std::array<AxisTaps, 3>& taps,
                  const std::array<int64_t, 3>& out_dims, const Executor& executor, float* out);

}  // namespace plc
