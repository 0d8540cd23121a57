// The iso-potential force (7) and trilinear sampling of an image (3.8).
#pragma once
#include <cstdint>

#include "kernels/image.h"
#include "kernels/ring.h"
#include "kernels/simd.h"

namespace plc::kernels {

// values[i] = trilinear interpolation of the image at position[i], i = begin .. end-1, any range:
// lerp(a, b, t) = a + (b - a) t along x, then y, then z.
void sample_trilinear(SimdTarget simd, const ImageView& image, const Float4* position,
                      uint32_t begin, uint32_t end, float* values);

// f += coefficient (iso - Pi(x)) n: eq. (7) with coefficient = delta alpha_I, signed.
// begin and end are multiples of kRingLanes.
void iso_force(SimdTarget simd, const ImageView& image, const Float4* position, const float* nx,
               const float* ny, const float* nz, float coefficient, float iso, uint32_t begin,
               uint32_t end, float* fx, float* fy, float* fz);

}  // namespace plc::kernels
