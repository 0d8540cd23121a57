#include "kernels/blend_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/blend_rows.cpp"
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
using scalar::blend_rows;
#else

void blend_rows(const std::array<const float*, 4>& rows, float y, float z, size_t begin, size_t end,
                float* out) {
  const FloatTag d;
  const Floats ty = hn::Set(d, y), tz = hn::Set(d, z);
  size_t i = begin;
  for (; end - i >= kLanes; i += kLanes) {
    const Floats below = lerp(hn::LoadU(d, rows[0] + i), hn::LoadU(d, rows[1] + i), ty);
    const Floats above = lerp(hn::LoadU(d, rows[2] + i), hn::LoadU(d, rows[3] + i), ty);
    hn::StoreU(lerp(below, above, tz), d, out + i);
  }
  scalar::blend_rows(rows, y, z, i, end, out);
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(blend_rows);

void blend_rows(SimdTarget simd, const std::array<const float*, 4>& rows, float y, float z,
                size_t begin, size_t end, float* out) {
  PLC_DISPATCH(simd, blend_rows)(rows, y, z, begin, end, out);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
