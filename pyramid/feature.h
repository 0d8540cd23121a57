// The image that attracts a snake to contours (paper, 3.8): the norm of a gradient.
#pragma once
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/status.h"
#include "pyramid/volume.h"

namespace plc {

// norm[i] = length of the Sobel gradient at voxel i, in the image's units per mm, of the volume
// convolved with a Gaussian of standard deviation sigma_mm (0: of the volume itself): "I is the
// norm of the gradient image of J (possibly convolved with a Gaussian kernel)". The Gaussian is
// sampled at the voxels, ceil(3 sigma / spacing) on either side on each axis, and sums to 1;
// borders are replicated. Voxels that are not finite count as the volume's lowest (NaN, -inf) or
// highest (inf) finite value. At most two float images of the volume's size exist at once, `norm`
// being one of them. Errors: kInvalidArgument and kInvalidData as build_pyramid's for the volume;
// kInvalidArgument (sigma negative or not finite, or reaching beyond the extent of an axis),
// kOutOfMemory; then `norm` is empty. The same bits for any executor and any target.
Status gradient_norm(const VolumeView& volume, double sigma_mm, const Executor& executor,
                     Buffer<float>& norm);

}  // namespace plc
