#include "kernels/nearby.h"

#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/nearby.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::near_or_turned;
#else

// Bit l: lane l. As many bytes are read as were written: a longer load would wait for the store.
HWY_INLINE uint64_t mask_bits(FloatMask mask) {
  uint8_t bytes[8];
  hn::StoreMaskBits(FloatTag(), mask, bytes);
  uint32_t bits = 0;
  std::memcpy(&bits, bytes, (kLanes + 7) / 8);
  return bits;
}

// By chunks of 64, without branches: which lanes hit is as good as random. Hits are few: their bits
// one by one cost less than compressing stores do.
uint32_t near_or_turned(const NearbyView& view, const NearbyQuery& q, uint32_t* hits) {
  const FloatTag d;
  const Floats3 place{hn::Set(d, q.x), hn::Set(d, q.y), hn::Set(d, q.z)};
  const Floats3 normal{hn::Set(d, q.nx), hn::Set(d, q.ny), hn::Set(d, q.nz)};
  const Floats far = hn::Set(d, q.far_squared), near = hn::Set(d, q.near_squared);
  const Floats most = hn::Set(d, q.most);
  uint32_t count = 0;
  for (uint32_t begin = 0; begin < view.count; begin += 64) {
    const uint32_t end = HWY_MIN(begin + 64, view.count);
    uint64_t bits = 0;
    for (uint32_t i = begin; i < end; i += kLanes) {
      const Floats3 apart = load3(view.x, view.y, view.z, i) - place;
      const Floats squared = dot(apart, apart);
      const FloatMask turned = hn::Le(dot(load3(view.nx, view.ny, view.nz, i), normal), most);
      const FloatMask hit = hn::And(hn::Le(squared, far), hn::Or(turned, hn::Lt(squared, near)));
      bits |= mask_bits(hit) << (i - begin);
    }
    if (end - begin < 64) bits &= (uint64_t{1} << (end - begin)) - 1;  // not the padding
    for (; bits != 0; bits &= bits - 1) {
      hits[count++] = begin + static_cast<uint32_t>(std::countr_zero(bits));
    }
  }
  return count;
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(near_or_turned);

uint32_t near_or_turned(SimdTarget simd, const NearbyView& view, const NearbyQuery& query,
                        uint32_t* hits) {
  return PLC_DISPATCH(simd, near_or_turned)(view, query, hits);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
