// The bounded gradient of an image of the pyramid (paper, 3.8): what the gradient force (8)
// samples.
#pragma once
#include <array>

#include "kernels/ring.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/pyramid.h"
#include "pyramid/status.h"

namespace plc {

// gradient[i] = (x, y, z, 0) at voxel i of `level`: the Sobel gradient per U_h, shortened to
// `bound` where it is longer, divided by `bound`, so that its length lies in [0,1]. The paper
// leaves the unit open: divided by the bound, the force has the size of (7) whatever the contrast.
// It is 0 in the voxels at the border, and so beyond it.
//   voxel_length: the length of a voxel along each axis in units of U_h; finite, > 0
//   bound:        change of the image's value per U_h; finite, > 0
// 16 bytes per voxel; besides, for a borrowed I_0, 4 while it is built. Errors: kInvalidArgument
// (bound, voxel_length), kOutOfMemory; then `gradient` is empty. The same bits for any executor and
// any target.
Status build_gradient(const PyramidLevel& level, const std::array<double, 3>& voxel_length,
                      double bound, const Executor& executor, Buffer<Float4>& gradient);

}  // namespace plc
