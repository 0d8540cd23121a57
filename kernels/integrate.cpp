#include "kernels/integrate.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/integrate.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/integrate-inl.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::max_squared;
using scalar::move;
using scalar::rk4_stage;
#else

template <int kStage>
HWY_INLINE void rk4_blocks(const Rk4Coefficients& coefficients, const Rk4Streams& s,
                           const ConstFloat3s& force, const Blocks& blocks) {
  const Rk4Lanes<kStage> lanes(coefficients);
  for (size_t b = 0; b < blocks.count; ++b) {
    const uint32_t begin = blocks.begin(b);
    for (uint32_t i = begin; i < begin + kRingLanes; i += kLanes) {
      run_stage(lanes, s, load3(force, i), i);
    }
  }
}

void rk4_stage(int stage, const Rk4Coefficients& coefficients, const Rk4Streams& streams,
               const ConstFloat3s& force, const Blocks& blocks) {
  with_stage(stage, [&](auto k) HWY_ATTR {
    rk4_blocks<decltype(k)::value>(coefficients, streams, force, blocks);
  });
}

float max_squared(const ConstFloat3s& moved, const Blocks& blocks) {
  Floats longest = hn::Zero(FloatTag());
  for (size_t b = 0; b < blocks.count; ++b) {
    const uint32_t begin = blocks.begin(b);
    for (uint32_t i = begin; i < begin + kRingLanes; i += kLanes) {
      const Floats3 by = load3(moved, i);
      const Floats length = dot(by, by);
      longest = hn::IfThenElse(hn::Gt(length, longest), length, longest);
    }
  }
  return MoveLanes::greatest(longest);
}

Movement move(const MoveBound& bound, const Float3s& moved, const ConstFloat3s& new_velocity,
              const MoveStreams& streams, const Blocks& blocks) {
  MoveLanes lanes(bound);
  for (size_t b = 0; b < blocks.count; ++b) {
    const uint32_t begin = blocks.begin(b);
    for (uint32_t part = 0; part < kRingLanes / kLanes; ++part) {
      const uint32_t i = begin + part * kLanes;
      lanes.move({load3(moved, i), load3(new_velocity, i)}, moved, streams, begin, part);
    }
  }
  return lanes.total();
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(rk4_stage);
HWY_EXPORT(max_squared);
HWY_EXPORT(move);

void rk4_stage(SimdTarget simd, int stage, const Rk4Coefficients& coefficients,
               const Rk4Streams& streams, const ConstFloat3s& force, const Blocks& blocks) {
  PLC_DISPATCH(simd, rk4_stage)(stage, coefficients, streams, force, blocks);
}

float max_squared(SimdTarget simd, const ConstFloat3s& moved, const Blocks& blocks) {
  return PLC_DISPATCH(simd, max_squared)(moved, blocks);
}

Movement move(SimdTarget simd, const MoveBound& bound, const Float3s& moved,
              const ConstFloat3s& new_velocity, const MoveStreams& streams, const Blocks& blocks) {
  return PLC_DISPATCH(simd, move)(bound, moved, new_velocity, streams, blocks);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
