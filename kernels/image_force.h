// The iso-potential force (7) and trilinear sampling of an image (3.8).
#pragma once
#include <cstdint>

#include "kernels/float3s.h"
#include "kernels/image.h"
#include "kernels/ring.h"
#include "kernels/simd.h"

namespace plc::kernels {

// values[i] = trilinear interpolation of the image at position[i], i = begin .. end-1, any range:
// lerp(a, b, t) = a + (b - a) t along x, then y, then z; what voxels beyond [0,1] make of it
// clipped to [0,1].
void sample_trilinear(SimdTarget simd, const ImageView& image, const Float4* position,
                      uint32_t begin, uint32_t end, float* values);

struct IsoPull {
  float coefficient;  // delta alpha_I, signed
  float iso;
};

// f += coefficient (iso - Pi(x)) n: eq. (7).
// begin and end are multiples of kRingLanes.
void iso_force(SimdTarget simd, const ImageView& image, const Float4* position, ConstFloat3s normal,
               const IsoPull& pull, uint32_t begin, uint32_t end, Float3s force);

}  // namespace plc::kernels
