// The gradient force (8) (3.8).
#pragma once
#include <array>
#include <cstdint>

#include "kernels/float3s.h"
#include "kernels/image.h"
#include "kernels/ring.h"
#include "kernels/simd.h"

namespace plc::kernels {

struct GradientPull {
  float along_normal;   // delta alpha
  float along_tangent;  // delta beta
  // A factor per axis, applied last: {1, 1, 1} unless the mesh lives in another metric than its
  // forces.
  std::array<float, 3> map;
};

// f += map [along_normal (g . n) n + along_tangent (g - (g . n) n)], where g is the trilinear
// interpolation of the gradient at position[i], by lerps along x, then y, then z: eq. (8).
// begin and end are multiples of kRingLanes.
void gradient_force(SimdTarget simd, const GradientView& gradient, const Float4* position,
                    ConstFloat3s normal, const GradientPull& pull, uint32_t begin, uint32_t end,
                    Float3s force);

}  // namespace plc::kernels
