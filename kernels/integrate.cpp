#include "kernels/integrate.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/integrate.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/lanes-inl.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::clamp_movement;
using scalar::max_squared;
using scalar::move;
using scalar::normal_energy_sum;
using scalar::rk4_stage;
#else

template <int kStage>
HWY_INLINE void rk4_range(const Rk4Coefficients& c, const Rk4Streams& s, uint32_t begin,
                          uint32_t end) {
  const FloatTag d;
  const Floats damping = hn::Set(d, c.damping);
  const Floats inverse_mass = hn::Set(d, c.inverse_mass);
  const Floats sixth = hn::Set(d, c.time_step / 6.0F);
  const Floats step = hn::Set(d, kStage == 2 ? c.time_step : c.time_step * 0.5F);
  for (uint32_t i = begin; i < end; i += kLanes) {
    const Floats3 velocity = load3(s.vx, s.vy, s.vz, i);
    const Floats3 w = kStage == 0 ? velocity : load3(s.sx, s.sy, s.sz, i);
    const Floats3 a = (load3(s.fx, s.fy, s.fz, i) - w * damping) * inverse_mass;
    if constexpr (kStage == 0) {
      store3(w, s.dx, s.dy, s.dz, i);
      store3(a, s.ax, s.ay, s.az, i);
    } else {
      const Floats3 moved = load3(s.dx, s.dy, s.dz, i);
      const Floats3 pushed = load3(s.ax, s.ay, s.az, i);
      if constexpr (kStage == 3) {
        store3((moved + w) * sixth, s.dx, s.dy, s.dz, i);
        store3(velocity + (pushed + a) * sixth, s.ax, s.ay, s.az, i);
      } else {
        store3(moved + (w + w), s.dx, s.dy, s.dz, i);
        store3(pushed + (a + a), s.ax, s.ay, s.az, i);
      }
    }
    if constexpr (kStage != 3) {
      store3(velocity + a * step, s.sx, s.sy, s.sz, i);
      store_packed(load3(s.px, s.py, s.pz, i) + w * step, s.stage + i);
    }
  }
}

void rk4_stage(int stage, const Rk4Coefficients& coefficients, const Rk4Streams& streams,
               uint32_t begin, uint32_t end) {
  switch (stage) {
    case 0:
      return rk4_range<0>(coefficients, streams, begin, end);
    case 1:
      return rk4_range<1>(coefficients, streams, begin, end);
    case 2:
      return rk4_range<2>(coefficients, streams, begin, end);
    default:
      return rk4_range<3>(coefficients, streams, begin, end);
  }
}

float max_squared(const float* dx, const float* dy, const float* dz, uint32_t begin, uint32_t end) {
  const FloatTag d;
  Floats longest = hn::Zero(d);
  for (uint32_t i = begin; i < end; i += kLanes) {
    const Floats3 moved = load3(dx, dy, dz, i);
    const Floats length = dot(moved, moved);
    longest = hn::IfThenElse(hn::Gt(length, longest), length, longest);
  }
  alignas(64) float lane[kLanes];
  hn::Store(longest, d, lane);
  float result = 0;
  for (const float value : lane) result = value > result ? value : result;
  return result;
}

HWY_INLINE Floats3 shortened(const Floats3& a, Floats longest) {
  const FloatTag d;
  const Floats length = hn::Sqrt(dot(a, a));
  const FloatMask too_long = hn::Gt(length, longest);
  // Most vectors are short enough: times 1 changes no bit.
  return a * hn::IfThenElse(too_long, hn::Div(longest, length), hn::Set(d, 1.0F));
}

void clamp_movement(float max_length, float max_speed, float* dx, float* dy, float* dz, float* vx,
                    float* vy, float* vz, uint32_t begin, uint32_t end) {
  const FloatTag d;
  for (uint32_t i = begin; i < end; i += kLanes) {
    store3(shortened(load3(dx, dy, dz, i), hn::Set(d, max_length)), dx, dy, dz, i);
    store3(shortened(load3(vx, vy, vz, i), hn::Set(d, max_speed)), vx, vy, vz, i);
  }
}

void move(const float* dx, const float* dy, const float* dz, float* px, float* py, float* pz,
          Packed* packed, float* path, uint32_t begin, uint32_t end) {
  const FloatTag d;
  for (uint32_t i = begin; i < end; i += kLanes) {
    const Floats3 moved = load3(dx, dy, dz, i);
    const Floats3 position = load3(px, py, pz, i) + moved;
    store3(position, px, py, pz, i);
    store_packed(position, packed + i);
    hn::StoreU(hn::Add(hn::LoadU(d, path + i), hn::Sqrt(dot(moved, moved))), d, path + i);
  }
}

double normal_energy_sum(const float* dx, const float* dy, const float* dz, const float* nx,
                         const float* ny, const float* nz, uint32_t begin, uint32_t end) {
  LaneSums sums;
  for (uint32_t block = begin; block < end; block += kRingLanes) {
    for (uint32_t part = 0; part < kRingLanes / kLanes; ++part) {
      const uint32_t i = block + part * kLanes;
      const Floats along = dot(load3(dx, dy, dz, i), load3(nx, ny, nz, i));
      const Doubles low = low_doubles(along);
      const Doubles high = high_doubles(along);
      sums.add(part, hn::Mul(low, low), hn::Mul(high, high));
    }
  }
  return sums.total();
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(rk4_stage);
HWY_EXPORT(max_squared);
HWY_EXPORT(clamp_movement);
HWY_EXPORT(move);
HWY_EXPORT(normal_energy_sum);

void rk4_stage(SimdTarget simd, int stage, const Rk4Coefficients& coefficients,
               const Rk4Streams& streams, uint32_t begin, uint32_t end) {
  PLC_DISPATCH(simd, rk4_stage)(stage, coefficients, streams, begin, end);
}

float max_squared(SimdTarget simd, const float* dx, const float* dy, const float* dz,
                  uint32_t begin, uint32_t end) {
  return PLC_DISPATCH(simd, max_squared)(dx, dy, dz, begin, end);
}

void clamp_movement(SimdTarget simd, float max_length, float max_speed, float* dx, float* dy,
                    float* dz, float* vx, float* vy, float* vz, uint32_t begin, uint32_t end) {
  PLC_DISPATCH(simd, clamp_movement)
  (max_length, max_speed, dx, dy, dz, vx, vy, vz, begin, end);
}

void move(SimdTarget simd, const float* dx, const float* dy, const float* dz, float* px, float* py,
          float* pz, Packed* packed, float* path, uint32_t begin, uint32_t end) {
  PLC_DISPATCH(simd, move)(dx, dy, dz, px, py, pz, packed, path, begin, end);
}

double normal_energy_sum(SimdTarget simd, const float* dx, const float* dy, const float* dz,
                         const float* nx, const float* ny, const float* nz, uint32_t begin,
                         uint32_t end) {
  return PLC_DISPATCH(simd, normal_energy_sum)(dx, dy, dz, nx, ny, nz, begin, end);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
