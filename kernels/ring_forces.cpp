#include "kernels/ring_forces.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/ring_forces.cpp"
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
using scalar::curvature_force;
using scalar::edge_length_sum;
using scalar::edge_violations;
using scalar::laplacian;
using scalar::metric_normals;
using scalar::normals;
using scalar::spring_force;
#else

// Lanes are vertices v .. v + kLanes - 1.
HWY_INLINE Floats load_valence(const RingView& ring, uint32_t v) {
  const hn::Rebind<uint16_t, FloatTag> d16;
  const hn::RebindToSigned<FloatTag> d32;
  return hn::ConvertTo(FloatTag(), hn::PromoteTo(d32, hn::LoadU(d16, ring.valence + v)));
}

// Calls sum.add(mask of the lanes that have slot k, record of slot k) for k = 0 .. until no lane
// has more, or the columns end.
template <class Sum>
HWY_INLINE void walk_ring(const RingView& ring, const Packed* record, uint32_t v, Floats valence,
                          Sum& sum) {
  const FloatTag d;
  const uint32_t* column =
      ring.columns + size_t{v / kRingLanes} * kRingColumns * kRingLanes + v % kRingLanes;
  Floats slot = hn::Zero(d);
  for (uint32_t k = 0; k < kRingSlots; ++k, column += kRingLanes) {
    const FloatMask has_slot = hn::Lt(slot, valence);
    if (hn::AllFalse(d, has_slot)) return;
    sum.add(has_slot, load_indexed(record, column));
    slot = hn::Add(slot, hn::Set(d, 1.0F));
  }
}

HWY_INLINE bool has_tails(Floats valence) {
  const FloatTag d;
  return !hn::AllFalse(d, hn::Gt(valence, hn::Set(d, static_cast<float>(kRingSlots))));
}

// Replaces the lanes whose ring goes on in the tail arena by ring_sum(vertex). Such vertices are
// rare (constraint (1) leaves little room around a vertex): they are summed again from slot 0.
template <class RingSum>
HWY_NOINLINE Floats3 with_tails(const RingView& ring, uint32_t v, const Floats3& sum,
                                const RingSum& ring_sum) {
  const FloatTag d;
  alignas(64) float x[kLanes], y[kLanes], z[kLanes];
  hn::Store(sum.x, d, x);
  hn::Store(sum.y, d, y);
  hn::Store(sum.z, d, z);
  for (uint32_t l = 0; l < kLanes; ++l) {
    if (ring.valence[v + l] <= kRingSlots) continue;
    const scalar::Triple whole = ring_sum(v + l);
    x[l] = whole.x;
    y[l] = whole.y;
    z[l] = whole.z;
  }
  return {hn::Load(d, x), hn::Load(d, y), hn::Load(d, z)};
}

// 1 / valence, 0 for deleted vertices.
HWY_INLINE Floats inverse_valence(Floats valence) {
  const FloatTag d;
  return hn::IfThenElseZero(hn::Gt(valence, hn::Zero(d)), hn::Div(hn::Set(d, 1.0F), valence));
}

struct DifferenceSum {
  Floats3 centre;
  Floats3 sum = zero3();
  HWY_INLINE void add(FloatMask has_slot, const Floats3& neighbour) {
    sum = sum + where(has_slot, neighbour - centre);
  }
};

void laplacian(const RingView& ring, const Packed* position, uint32_t begin, uint32_t end,
               Packed* laplacian) {
  for (uint32_t v = begin; v < end; v += kLanes) {
    const Floats valence = load_valence(ring, v);
    DifferenceSum walk{load_packed(position + v)};
    walk_ring(ring, position, v, valence, walk);
    if (HWY_UNLIKELY(has_tails(valence))) {
      walk.sum = with_tails(ring, v, walk.sum,
                            [&](uint32_t u) { return scalar::difference_sum(ring, position, u); });
    }
    store_packed(walk.sum * inverse_valence(valence), laplacian + v);
  }
}

struct RecordSum {
  Floats3 sum = zero3();
  HWY_INLINE void add(FloatMask has_slot, const Floats3& record) {
    sum = sum + where(has_slot, record);
  }
};

void curvature_force(const RingView& ring, const Packed* laplacian, float alpha_c, uint32_t begin,
                     uint32_t end, float* fx, float* fy, float* fz) {
  const FloatTag d;
  const Floats alpha = hn::Set(d, alpha_c);
  for (uint32_t v = begin; v < end; v += kLanes) {
    const Floats valence = load_valence(ring, v);
    RecordSum walk{};
    walk_ring(ring, laplacian, v, valence, walk);
    if (HWY_UNLIKELY(has_tails(valence))) {
      walk.sum = with_tails(ring, v, walk.sum,
                            [&](uint32_t u) { return scalar::record_sum(ring, laplacian, u); });
    }
    const FloatMask alive = hn::Gt(valence, hn::Zero(d));
    const Floats3 own = load_packed(laplacian + v);
    store3(where(alive, (own - walk.sum * inverse_valence(valence)) * alpha), fx, fy, fz, v);
  }
}

HWY_INLINE Floats3 scaled(const Floats3& a, const Floats3& s) {
  return {hn::Mul(a.x, s.x), hn::Mul(a.y, s.y), hn::Mul(a.z, s.z)};
}
HWY_INLINE Floats length_in(const Floats3& metric, const Floats3& edge) {
  const Floats3 measured = scaled(edge, metric);
  return hn::Sqrt(dot(measured, measured));
}
HWY_INLINE Floats3 spread(const Metric& metric) {
  const FloatTag d;
  return {hn::Set(d, metric.x), hn::Set(d, metric.y), hn::Set(d, metric.z)};
}

struct SpringSum {
  Floats3 centre;
  Floats rest_length;
  Floats3 metric;
  Floats3 sum = zero3();
  HWY_INLINE void add(FloatMask has_slot, const Floats3& neighbour) {
    const Floats3 edge = neighbour - centre;
    const Floats length = length_in(metric, edge);
    const FloatMask apart = hn::And(has_slot, hn::Gt(length, hn::Zero(FloatTag())));
    const Floats pull = hn::Div(hn::Sub(length, rest_length), length);
    sum = sum + where(apart, edge * pull);
  }
};

void spring_force(const RingView& ring, const Packed* position, float alpha_e, float rest_length,
                  const Metric& metric, uint32_t begin, uint32_t end, float* fx, float* fy,
                  float* fz) {
  const FloatTag d;
  const Floats alpha = hn::Set(d, alpha_e);
  for (uint32_t v = begin; v < end; v += kLanes) {
    const Floats valence = load_valence(ring, v);
    SpringSum walk{load_packed(position + v), hn::Set(d, rest_length), spread(metric)};
    walk_ring(ring, position, v, valence, walk);
    if (HWY_UNLIKELY(has_tails(valence))) {
      walk.sum = with_tails(ring, v, walk.sum, [&](uint32_t u) {
        return scalar::spring_sum(ring, position, rest_length, metric, u);
      });
    }
    store3(load3(fx, fy, fz, v) + walk.sum * alpha, fx, fy, fz, v);
  }
}

struct NormalSum {
  Floats3 centre;
  Floats3 first = zero3(), last = zero3(), sum = zero3();
  bool started = false;
  HWY_INLINE void add(FloatMask has_slot, const Floats3& neighbour) {
    const Floats3 edge = neighbour - centre;
    if (!started) {
      first = last = where(has_slot, edge);
      started = true;
      return;
    }
    sum = sum + where(has_slot, cross(last, edge));
    last.x = hn::IfThenElse(has_slot, edge.x, last.x);
    last.y = hn::IfThenElse(has_slot, edge.y, last.y);
    last.z = hn::IfThenElse(has_slot, edge.z, last.z);
  }
};

void normals(const RingView& ring, const Packed* position, uint32_t begin, uint32_t end, float* nx,
             float* ny, float* nz) {
  const FloatTag d;
  for (uint32_t v = begin; v < end; v += kLanes) {
    const Floats valence = load_valence(ring, v);
    NormalSum walk{load_packed(position + v)};
    walk_ring(ring, position, v, valence, walk);
    walk.sum = walk.sum + cross(walk.last, walk.first);
    if (HWY_UNLIKELY(has_tails(valence))) {
      walk.sum = with_tails(ring, v, walk.sum,
                            [&](uint32_t u) { return scalar::normal_sum(ring, position, u); });
    }
    const Floats length = hn::Sqrt(dot(walk.sum, walk.sum));
    const FloatMask some = hn::Gt(length, hn::Zero(d));
    const Floats inverse = hn::IfThenElseZero(some, hn::Div(hn::Set(d, 1.0F), length));
    store3(walk.sum * inverse, nx, ny, nz, v);
  }
}

void metric_normals(const Metric& metric, const float* nx, const float* ny, const float* nz,
                    uint32_t begin, uint32_t end, float* mx, float* my, float* mz, float* step_x,
                    float* step_y, float* step_z) {
  const FloatTag d;
  const Floats one = hn::Set(d, 1.0F);
  const Floats3 lengths = spread(metric);
  const Floats3 inverse{hn::Div(one, lengths.x), hn::Div(one, lengths.y), hn::Div(one, lengths.z)};
  for (uint32_t v = begin; v < end; v += kLanes) {
    const Floats3 k = scaled(load3(nx, ny, nz, v), inverse);
    const Floats length = hn::Sqrt(dot(k, k));
    const FloatMask some = hn::Gt(length, hn::Zero(d));
    const Floats3 m = k * hn::IfThenElseZero(some, hn::Div(one, length));
    store3(m, mx, my, mz, v);
    store3(scaled(m, inverse), step_x, step_y, step_z, v);
  }
}

struct EdgeLimits {
  Floats3 centre;
  Floats min_squared, max_squared;
  FloatMask too_short = hn::MaskFromVec(hn::Zero(FloatTag()));
  FloatMask too_long = too_short;
  HWY_INLINE void add(FloatMask has_slot, const Floats3& neighbour) {
    const Floats3 edge = neighbour - centre;
    const Floats length = dot(edge, edge);
    too_short = hn::Or(too_short, hn::And(has_slot, hn::Le(length, min_squared)));
    too_long = hn::Or(too_long, hn::And(has_slot, hn::Ge(length, max_squared)));
  }
};

void edge_violations(const RingView& ring, const Packed* position, float min_squared,
                     float max_squared, uint32_t begin, uint32_t end, uint8_t* flags) {
  const FloatTag d;
  const hn::RebindToSigned<FloatTag> d32;
  const hn::Rebind<uint8_t, FloatTag> d8;
  for (uint32_t v = begin; v < end; v += kLanes) {
    const Floats valence = load_valence(ring, v);
    EdgeLimits walk{load_packed(position + v), hn::Set(d, min_squared), hn::Set(d, max_squared)};
    walk_ring(ring, position, v, valence, walk);
    const auto bits =
        hn::Or(hn::IfThenElseZero(hn::RebindMask(d32, walk.too_short), hn::Set(d32, 1)),
               hn::IfThenElseZero(hn::RebindMask(d32, walk.too_long), hn::Set(d32, 2)));
    hn::StoreU(hn::DemoteTo(d8, bits), d8, flags + v);
    if (HWY_LIKELY(!has_tails(valence))) continue;
    for (uint32_t u = v; u < v + kLanes; ++u) {
      if (ring.valence[u] <= kRingSlots) continue;
      flags[u] = scalar::violation_flags(ring, position, min_squared, max_squared, u);
    }
  }
}

struct LengthSum {
  Floats3 centre;
  Floats3 metric;
  Floats sum = hn::Zero(FloatTag());
  HWY_INLINE void add(FloatMask has_slot, const Floats3& neighbour) {
    sum = hn::Add(sum, hn::IfThenElseZero(has_slot, length_in(metric, neighbour - centre)));
  }
};

double edge_length_sum(const RingView& ring, const Packed* position, const Metric& metric,
                       uint32_t begin, uint32_t end) {
  LaneSums sums;
  for (uint32_t block = begin; block < end; block += kRingLanes) {
    for (uint32_t part = 0; part < kRingLanes / kLanes; ++part) {
      const uint32_t v = block + part * kLanes;
      const Floats valence = load_valence(ring, v);
      LengthSum walk{load_packed(position + v), spread(metric)};
      walk_ring(ring, position, v, valence, walk);
      if (HWY_UNLIKELY(has_tails(valence))) {
        walk.sum = with_tails(ring, v, {walk.sum, walk.sum, walk.sum}, [&](uint32_t u) {
                     return scalar::Triple{scalar::length_sum(ring, position, metric, u), 0, 0};
                   }).x;
      }
      sums.add(part, low_doubles(walk.sum), high_doubles(walk.sum));
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

HWY_EXPORT(laplacian);
HWY_EXPORT(curvature_force);
HWY_EXPORT(spring_force);
HWY_EXPORT(normals);
HWY_EXPORT(metric_normals);
HWY_EXPORT(edge_violations);
HWY_EXPORT(edge_length_sum);

void laplacian(SimdTarget simd, const RingView& ring, const Packed* position, uint32_t begin,
               uint32_t end, Packed* laplacian) {
  PLC_DISPATCH(simd, laplacian)(ring, position, begin, end, laplacian);
}

void curvature_force(SimdTarget simd, const RingView& ring, const Packed* laplacian, float alpha_c,
                     uint32_t begin, uint32_t end, float* fx, float* fy, float* fz) {
  PLC_DISPATCH(simd, curvature_force)(ring, laplacian, alpha_c, begin, end, fx, fy, fz);
}

void spring_force(SimdTarget simd, const RingView& ring, const Packed* position, float alpha_e,
                  float rest_length, const Metric& metric, uint32_t begin, uint32_t end, float* fx,
                  float* fy, float* fz) {
  PLC_DISPATCH(simd, spring_force)
  (ring, position, alpha_e, rest_length, metric, begin, end, fx, fy, fz);
}

void normals(SimdTarget simd, const RingView& ring, const Packed* position, uint32_t begin,
             uint32_t end, float* nx, float* ny, float* nz) {
  PLC_DISPATCH(simd, normals)(ring, position, begin, end, nx, ny, nz);
}

void metric_normals(SimdTarget simd, const Metric& metric, const float* nx, const float* ny,
                    const float* nz, uint32_t begin, uint32_t end, float* mx, float* my, float* mz,
                    float* step_x, float* step_y, float* step_z) {
  PLC_DISPATCH(simd, metric_normals)
  (metric, nx, ny, nz, begin, end, mx, my, mz, step_x, step_y, step_z);
}

void edge_violations(SimdTarget simd, const RingView& ring, const Packed* position,
                     float min_squared, float max_squared, uint32_t begin, uint32_t end,
                     uint8_t* flags) {
  PLC_DISPATCH(simd, edge_violations)
  (ring, position, min_squared, max_squared, begin, end, flags);
}

double edge_length_sum(SimdTarget simd, const RingView& ring, const Packed* position,
                       const Metric& metric, uint32_t begin, uint32_t end) {
  return PLC_DISPATCH(simd, edge_length_sum)(ring, position, metric, begin, end);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
