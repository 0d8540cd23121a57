#include "kernels/gradient_force.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/gradient_force.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/cells-inl.h"
#include "kernels/dispatch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::gradient_force;
#else

HWY_INLINE Floats3 lerp3(const Floats3& a, const Floats3& b, Floats t) {
  return a + (b - a) * t;
}

// Bilinear in the plane of voxels: x, then y.
HWY_INLINE Floats3 sample_plane(const Float4* plane, const Place& at) {
  const Float4* next = plane + at.row;
  const Floats3 low = lerp3(load_indexed(plane, at.cell), load_indexed(plane + 1, at.cell), at.x);
  const Floats3 high = lerp3(load_indexed(next, at.cell), load_indexed(next + 1, at.cell), at.x);
  return lerp3(low, high, at.y);
}

HWY_INLINE Floats3 sample(const GradientView& gradient, const Floats3& p) {
  const Place at = locate(gradient, p);
  return lerp3(sample_plane(gradient.data, at), sample_plane(gradient.data + at.plane, at), at.z);
}

void gradient_force(const GradientView& gradient, const Float4* position, ConstFloat3s normal,
                    const GradientPull& pull, uint32_t begin, uint32_t end, Float3s force) {
  const FloatTag d;
  const Floats normal_factor = hn::Set(d, pull.along_normal);
  const Floats tangent_factor = hn::Set(d, pull.along_tangent);
  for (uint32_t i = begin; i < end; i += kLanes) {
    const Floats3 g = sample(gradient, load_packed(position + i));
    const Floats3 n = load3(normal, i);
    const Floats3 normal_part = n * dot(g, n);
    const Floats3 tangent_part = g - normal_part;
    const Floats3 pulled = normal_part * normal_factor + tangent_part * tangent_factor;
    const Floats3 mapped = {hn::Mul(pulled.x, hn::Set(d, pull.map[0])),
                            hn::Mul(pulled.y, hn::Set(d, pull.map[1])),
                            hn::Mul(pulled.z, hn::Set(d, pull.map[2]))};
    store3(load3(force, i) + mapped, force, i);
  }
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(gradient_force);

void gradient_force(SimdTarget simd, const GradientView& gradient, const Float4* position,
                    ConstFloat3s normal, const GradientPull& pull, uint32_t begin, uint32_t end,
                    Float3s force) {
  PLC_DISPATCH(simd, gradient_force)
  (gradient, position, normal, pull, begin, end, force);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
