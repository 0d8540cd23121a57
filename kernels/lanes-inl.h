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

#if HWY_TARGET == HWY_WASM  // Highway has no vectors of doubles there before its version 1.0.4
struct Doubles {
  double lane[2];
};
inline constexpr uint32_t kDoubleLanes = 2;

HWY_INLINE Doubles low_doubles(Floats a) {
  alignas(16) float lane[4];
  hn::Store(a, FloatTag(), lane);
  return {{lane[0], lane[1]}};
}
HWY_INLINE Doubles high_doubles(Floats a) {
  alignas(16) float lane[4];
  hn::Store(a, FloatTag(), lane);
  return {{lane[2], lane[3]}};
}
HWY_INLINE Doubles zero_doubles() {
  return {{0, 0}};
}
HWY_INLINE Doubles sum_of(const Doubles& a, const Doubles& b) {
  return {{a.lane[0] + b.lane[0], a.lane[1] + b.lane[1]}};
}
HWY_INLINE Doubles square_of(const Doubles& a) {
  return {{a.lane[0] * a.lane[0], a.lane[1] * a.lane[1]}};
}
HWY_INLINE void store(const Doubles& a, double* to) {
  to[0] = a.lane[0];
  to[1] = a.lane[1];
}
#else
using DoubleTag = hn::ScalableTag<double>;
using Doubles = hn::Vec<DoubleTag>;
inline constexpr uint32_t kDoubleLanes = static_cast<uint32_t>(hn::MaxLanes(DoubleTag()));

HWY_INLINE Doubles low_doubles(Floats a) {
  return hn::PromoteTo(DoubleTag(), hn::LowerHalf(a));
}
HWY_INLINE Doubles high_doubles(Floats a) {
  return hn::PromoteTo(DoubleTag(), hn::UpperHalf(hn::Half<FloatTag>(), a));
}
HWY_INLINE Doubles zero_doubles() {
  return hn::Zero(DoubleTag());
}
HWY_INLINE Doubles sum_of(Doubles a, Doubles b) {
  return hn::Add(a, b);
}
HWY_INLINE Doubles square_of(Doubles a) {
  return hn::Mul(a, a);
}
HWY_INLINE void store(Doubles a, double* to) {
  hn::Store(a, DoubleTag(), to);
}
#endif

// Accumulator l is lane l % kDoubleLanes of sum[l / kDoubleLanes].
struct LaneSums {
  Doubles sum[kRingLanes / kDoubleLanes];

  HWY_INLINE LaneSums() {
    for (Doubles& s : sum) s = zero_doubles();
  }
  // Adds vertices kLanes * part .. of a block.
  HWY_INLINE void add(uint32_t part, Doubles low, Doubles high) {
    sum[2 * part] = sum_of(sum[2 * part], low);
    sum[2 * part + 1] = sum_of(sum[2 * part + 1], high);
  }
  HWY_INLINE double total() const {
    alignas(64) double lane[kRingLanes];
    for (uint32_t i = 0; i < kRingLanes / kDoubleLanes; ++i) store(sum[i], lane + i * kDoubleLanes);
    return add_lanes(lane);
  }
};

}  // namespace plc::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // include guard per target
