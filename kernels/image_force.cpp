#include "kernels/image_force.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/image_force.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/sample-inl.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::iso_force;
using scalar::sample_trilinear;
#else

void sample_trilinear(const ImageView& image, const Float4* position, uint32_t begin, uint32_t end,
                      float* values) {
  uint32_t i = begin;
  with_voxel_type(image.form.type, [&](auto voxel) HWY_ATTR {
    for (; end - i >= kLanes; i += kLanes) {
      const Floats value = sample<decltype(voxel)>(image, load_packed(position + i));
      hn::StoreU(value, FloatTag(), values + i);
    }
  });
  scalar::sample_trilinear(image, position, i, end, values);
}

void iso_force(const ImageView& image, const Float4* position, ConstFloat3s normal,
               const IsoPull& pull, uint32_t begin, uint32_t end, Float3s force) {
  with_voxel_type(image.form.type, [&](auto voxel) HWY_ATTR {
    const FloatTag d;
    for (uint32_t i = begin; i < end; i += kLanes) {
      const Floats value = sample<decltype(voxel)>(image, load_packed(position + i));
      const Floats push =
          hn::Mul(hn::Set(d, pull.coefficient), hn::Sub(hn::Set(d, pull.iso), value));
      store3(load3(force, i) + load3(normal, i) * push, force, i);
    }
  });
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(sample_trilinear);
HWY_EXPORT(iso_force);

void sample_trilinear(SimdTarget simd, const ImageView& image, const Float4* position,
                      uint32_t begin, uint32_t end, float* values) {
  const BrickReads reads(image.bricks);
  PLC_DISPATCH(simd, sample_trilinear)(image, position, begin, end, values);
}

void iso_force(SimdTarget simd, const ImageView& image, const Float4* position, ConstFloat3s normal,
               const IsoPull& pull, uint32_t begin, uint32_t end, Float3s force) {
  const BrickReads reads(image.bricks);
  PLC_DISPATCH(simd, iso_force)
  (image, position, normal, pull, begin, end, force);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
