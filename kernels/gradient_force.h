// The gradient force (8) (3.8).
#pragma once
#include <array>
#include <cstdint>

#include "kernels/image.h"
#include "kernels/ring.h"
#include "kernels/simd.h"

namespace plc::kernels {

// f += map [along_normal (g . n) n + along_tangent (g - (g . n) n)], where g is the trilinear
// interpolation of the gradient at position[i], by lerps along x, then y, then z: eq. (8) with
// along_normal = delta alpha and along_tangent = delta beta. `map` is a factor per axis, applied
// last: {1, 1, 1} unless the mesh lives in another metric than its forces.
// begin and end are multiples of kRingLanes.
void gradient_force(SimdTarget simd, const GradientView& gradient, const Float4* position,
                    const float* nx, const float* ny, const float* nz, float along_normal,
                    float along_tangent, const std::array<float, 3>& map, uint32_t begin,
                    uint32_t end, float* fx, float* fy, float* fz);

}  // namespace plc::kernels
