#include "kernels/weighted_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/weighted_rows.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::weighted_rows;
#else

void weighted_rows(const float* weights, size_t taps, const float* const* rows, size_t begin,
                   size_t end, float* out) {
  const FloatTag d;
  size_t i = begin;
  for (; end - i >= kLanes; i += kLanes) {
    Floats sum = hn::Mul(hn::Set(d, weights[0]), hn::LoadU(d, rows[0] + i));
    for (size_t k = 1; k < taps; ++k) {
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, rows[k] + i)));
    }
    hn::StoreU(sum, d, out + i);
  }
  scalar::weighted_rows(weights, taps, rows, i, end, out);
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(weighted_rows);

void weighted_rows(SimdTarget simd, const float* weights, size_t taps, const float* const* rows,
                   size_t begin, size_t end, float* out) {
  PLC_DISPATCH(simd, weighted_rows)(weights, taps, rows, begin, end, out);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
