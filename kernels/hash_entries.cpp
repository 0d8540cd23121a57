#include "kernels/hash_entries.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/hash_entries.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::entries_within;
#else

uint32_t entries_within(const uint32_t* ids, const CoarsePlace* places, const EntryRun* runs,
                        size_t count, const CoarseBox& box, uint32_t* out) {
  const hn::ScalableTag<uint32_t> d;
  const auto guards = hn::Set(d, kPlaceGuards), low = hn::Set(d, box.low);
  const auto extent = hn::Set(d, box.extent | kPlaceGuards);
  uint32_t found = 0;
  for (const EntryRun* run = runs; run != runs + count; ++run) {
    for (uint32_t i = run->first; i < run->last; i += kLanes) {
      // may_be_within()
      const auto place = hn::Or(hn::LoadU(d, places + i), guards);
      const auto from_low = hn::AndNot(guards, hn::Sub(place, low));
      const auto within = hn::Eq(hn::And(hn::Sub(extent, from_low), guards), guards);
      const auto hit = hn::And(within, hn::FirstN(d, run->last - i));
      // Not CompressStore, which is slow into memory on some processors.
      hn::StoreU(hn::Compress(hn::LoadU(d, ids + i), hit), d, out + found);
      found += static_cast<uint32_t>(hn::CountTrue(d, hit));
    }
  }
  return found;
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(entries_within);

uint32_t entries_within(SimdTarget simd, const uint32_t* ids, const CoarsePlace* places,
                        const EntryRun* runs, size_t count, const CoarseBox& box, uint32_t* out) {
  return PLC_DISPATCH(simd, entries_within)(ids, places, runs, count, box, out);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
