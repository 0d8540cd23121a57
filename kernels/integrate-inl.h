// The lanes of kernels/integrate.h, for the kernels that move vertices. Included once per target.
#if defined(PELLICLE_KERNELS_INTEGRATE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PELLICLE_KERNELS_INTEGRATE_INL_H
#undef PELLICLE_KERNELS_INTEGRATE_INL_H
#else
#define PELLICLE_KERNELS_INTEGRATE_INL_H
#endif

#include <type_traits>

#include "kernels/integrate.h"
#include "kernels/lanes-inl.h"
#include "kernels/vectors-inl.h"

#if !PLC_SCALAR_TARGET
HWY_BEFORE_NAMESPACE();
namespace plc::kernels::HWY_NAMESPACE {

// Coefficients of stage kStage in all lanes.
template <int kStage>
struct Rk4Lanes {
  Floats damping, inverse_mass, sixth, step;
  HWY_INLINE explicit Rk4Lanes(const Rk4Coefficients& c)
      : damping(hn::Set(FloatTag(), c.damping)),
        inverse_mass(hn::Set(FloatTag(), c.inverse_mass)),
        sixth(hn::Set(FloatTag(), c.time_step / 6.0F)),
        step(hn::Set(FloatTag(), kStage == 2 ? c.time_step : c.time_step * 0.5F)) {}

  // Stages 0..2 of the vertices i .. under a force.
  HWY_INLINE void advance(const Rk4Streams& s, const Floats3& force, uint32_t i) const {
    const Floats3 velocity = load3(s.velocity, i);
    const Floats3 w = kStage == 0 ? velocity : load3(s.speed, i);
    const Floats3 a = (force - w * damping) * inverse_mass;
    store_packed(load_packed(s.position + i) + w * step, s.stage + i);
    store3(velocity + a * step, s.speed, i);
    if constexpr (kStage == 0) {
      store3(a, s.rate, i);
    } else {
      store3((kStage == 1 ? velocity : load3(ConstFloat3s{s.moved.x, s.moved.y, s.moved.z}, i)) +
                 (w + w),
             s.moved, i);
      store3(load3(s.rate, i) + (a + a), s.rate, i);
    }
  }
};

// body(stage): once, with the stage as a constant of its type. The choice is made here, outside of
// loops.
template <class Body>
HWY_INLINE void with_stage(int stage, const Body& body) {
  switch (stage) {
    case 0:
      return body(std::integral_constant<int, 0>());
    case 1:
      return body(std::integral_constant<int, 1>());
    case 2:
      return body(std::integral_constant<int, 2>());
    default:
      return body(std::integral_constant<int, 3>());
  }
}

// What stage 3 finds.
struct Arrival {
  Floats3 moved, velocity;
};
HWY_INLINE Arrival arrive(const Rk4Lanes<3>& c, const Rk4Streams& s, const Floats3& force,
                          uint32_t i) {
  const Floats3 w = load3(s.speed, i);
  const Floats3 a = (force - w * c.damping) * c.inverse_mass;
  return {(load3(s.moved, i) + w) * c.sixth,
          load3(s.velocity, i) + (load3(s.rate, i) + a) * c.sixth};
}

// Any stage of the vertices i .. under a force; what stage 3 finds goes to moved and rate.
template <int kStage>
HWY_INLINE void run_stage(const Rk4Lanes<kStage>& lanes, const Rk4Streams& s, const Floats3& force,
                          uint32_t i) {
  if constexpr (kStage == 3) {
    const Arrival end = arrive(lanes, s, force, i);
    store3(end.moved, s.moved, i);
    store3(end.velocity, s.rate, i);
  } else {
    lanes.advance(s, force, i);
  }
}

HWY_INLINE Floats3 shortened(const Floats3& a, Floats squared, Floats longest) {
  const FloatTag d;
  const Floats length = hn::Sqrt(squared);
  const FloatMask too_long = hn::Gt(length, longest);
  // Most vectors are short enough: times 1 changes no bit.
  return a * hn::IfThenElse(too_long, hn::Div(longest, length), hn::Set(d, 1.0F));
}

// Ends the step of vertex after vertex and measures it.
class MoveLanes {
 public:
  HWY_INLINE explicit MoveLanes(const MoveBound& bound)
      : length_(hn::Set(FloatTag(), bound.length)),
        speed_(hn::Set(FloatTag(), bound.speed)),
        counted_(hn::Set(FloatTag(), bound.counted)),
        free_turns_(hn::Set(IntTag(), static_cast<int32_t>(bound.free_turns))),
        swinging_turns_(hn::Set(IntTag(), static_cast<int32_t>(bound.swinging_turns))) {}

  // Lanes kLanes * part .. of the block at `begin`.
  HWY_INLINE void move(const Arrival& arrival, const Float3s& moved, const MoveStreams& s,
                       uint32_t begin, uint32_t part) {
    const FloatTag d;
    const uint32_t i = begin + part * kLanes;
    const Floats3& v = arrival.velocity;
    const IntLanes turns = count_of(s.turns + i);
    const Floats4 before = load_packed4(s.position + i);
    // Where the mesh is finer than delta, movements are.
    const Floats one = hn::Set(d, 1.0F);
    const Floats slowed = hn::Mul(slowness(turns), hn::Min(hn::Add(one, before.w), one));
    const Floats3 by =
        shortened(arrival.moved, dot(arrival.moved, arrival.moved), hn::Mul(length_, slowed));
    const Floats squared = dot(by, by);
    store3(by, moved, i);
    const Floats fastest = hn::IfThenElseZero(swings(turns), hn::Mul(speed_, slowed));
    store3(shortened(v, dot(v, v), fastest), s.velocity, i);
    store_packed(Floats3{before.x, before.y, before.z} + by, before.w, s.moved_to + i);
    hn::StoreU(hn::Add(hn::LoadU(d, s.path + i), hn::Sqrt(squared)), d, s.path + i);
    longest_ = hn::IfThenElse(hn::Gt(squared, longest_), squared, longest_);
    const Floats along = hn::Min(hn::Abs(dot(by, load3(s.normal, i))), counted_);
    energy_.add(part, square_of(low_doubles(along)), square_of(high_doubles(along)));
  }
  HWY_INLINE Movement total() const { return {energy_.total(), greatest(longest_)}; }

  static HWY_INLINE float greatest(Floats values) {
    alignas(64) float lane[kLanes];
    hn::Store(values, FloatTag(), lane);
    float result = 0;
    for (const float value : lane) result = value > result ? value : result;
    return result;
  }

 private:
  using IntTag = hn::Rebind<int32_t, FloatTag>;
  using IntLanes = hn::Vec<IntTag>;

  static HWY_INLINE IntLanes count_of(const uint8_t* turns) {
    const IntTag d;
    return hn::And(hn::PromoteTo(d, hn::LoadU(hn::Rebind<uint8_t, FloatTag>(), turns)),
                   hn::Set(d, static_cast<int32_t>(kTurnsMask)));
  }
  HWY_INLINE FloatMask swings(IntLanes turns) const {
    return hn::RebindMask(FloatTag(), hn::Not(hn::Gt(turns, swinging_turns_)));
  }
  // 2^-(turns beyond the free ones), 0 for kSlowingTurns and more.
  HWY_INLINE Floats slowness(IntLanes turns) const {
    const IntTag d;
    const auto beyond = hn::Max(hn::Sub(turns, free_turns_), hn::Zero(d));
    constexpr int kExponentOfOne = 127, kMantissaBits = 23;
    const auto power = hn::ShiftLeft<kMantissaBits>(hn::Sub(hn::Set(d, kExponentOfOne), beyond));
    const auto moves = hn::Lt(beyond, hn::Set(d, static_cast<int32_t>(kSlowingTurns)));
    return hn::BitCast(FloatTag(), hn::IfThenElseZero(moves, power));
  }

  Floats length_, speed_, counted_;
  IntLanes free_turns_, swinging_turns_;
  Floats longest_ = hn::Zero(FloatTag());
  LaneSums energy_;
};

}  // namespace plc::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // include guard per target
