// The 16 accumulators of kernels/lane_sum.h in vectors of doubles. Included once per target.
#if defined(PELLICLE_KERNELS_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PELLICLE_KERNELS_LANES_INL_H
#undef PELLICLE_KERNELS_LANES_INL_H
#else
#define PELLICLE_KERNELS_LANES_INL_H
#endif

#include "kernels/lane_sum.h"
#include "kernels/vectors-inl.h"

#if !PLC_SCALAR_TARGET
HWY_BEFORE_NAMESPACE();
namespace plc::kernels::HWY_NAMESPACE {

using DoubleTag = hn::ScalableTag<double>;
using Doubles = hn::Vec<DoubleTag>;
inline constexpr uint32_t kDoubleLanes = static_cast<uint32_t>(hn::MaxLanes(DoubleTag()));

HWY_INLINE Doubles low_doubles(Floats a) {
  return hn::PromoteTo(DoubleTag(), hn::LowerHalf(a));
}
HWY_INLINE Doubles high_doubles(Floats a) {
  return hn::PromoteTo(DoubleTag(), hn::UpperHalf(hn::Half<FloatTag>(), a));
}

// Accumulator l is lane l % kDoubleLanes of sum[l / kDoubleLanes].
struct LaneSums {
  Doubles sum[kRingLanes / kDoubleLanes];

  HWY_INLINE LaneSums() {
    for (Doubles& s : sum) s = hn::Zero(DoubleTag());
  }
  // Adds vertices kLanes * part .. of a block.
  HWY_INLINE void add(uint32_t part, Doubles low, Doubles high) {
    sum[2 * part] = hn::Add(sum[2 * part], low);
    sum[2 * part + 1] = hn::Add(sum[2 * part + 1], high);
  }
  HWY_INLINE double total() const {
    const DoubleTag d;
    alignas(64) double lane[kRingLanes];
    for (uint32_t i = 0; i < kRingLanes / kDoubleLanes; ++i) {
      hn::Store(sum[i], d, lane + i * kDoubleLanes);
    }
    return add_lanes(lane);
  }
};

}  // namespace plc::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // include guard per target
