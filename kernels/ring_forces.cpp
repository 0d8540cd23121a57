#include "kernels/ring_forces.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/ring_forces.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/lanes-inl.h"
#include "kernels/ring-inl.h"
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
using scalar::normals_and_laplacian;
using scalar::spring_force;
using scalar::turned_faces;
#else

// visit(v) for vertices v .. v + kLanes - 1 of the blocks.
template <class Visit>
HWY_INLINE void for_lanes(const RingView& ring, const Float4* position, const Blocks& blocks,
                          const Visit& visit) {
  for (size_t b = 0; b < blocks.count; ++b) {
    if (blocks.comes(b + kAhead)) {
      prefetch_ring(ring, blocks.begin(b + kAhead));
      prefetch_records(position, blocks.begin(b + kAhead));
    }
    const uint32_t begin = blocks.begin(b);
    for (uint32_t v = begin; v < begin + kRingLanes; v += kLanes) visit(v);
  }
}

void laplacian(const RingView& ring, const Float4* position, const Blocks& blocks,
               Float4* laplacian) {
  for_lanes(ring, position, blocks, [&](uint32_t v) HWY_ATTR {
    const Floats valence = load_valence(ring, v);
    const Floats3 sum = difference_sum(ring, position, v, valence);
    store_packed(sum * inverse_valence(valence), laplacian + v);
  });
}

void curvature_force(const RingView& ring, const Float4* laplacian, float alpha_c, uint32_t begin,
                     uint32_t end, Float3s force) {
  const FloatTag d;
  const Floats alpha = hn::Set(d, alpha_c);
  for (uint32_t v = begin; v < end; v += kLanes) {
    const Floats valence = load_valence(ring, v);
    const Floats3 sum = record_sum(ring, laplacian, v, valence);
    const FloatMask alive = hn::Gt(valence, hn::Zero(d));
    const Floats3 own = load_packed(laplacian + v);
    store3(where(alive, (own - sum * inverse_valence(valence)) * alpha), force, v);
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

void spring_force(const RingView& ring, const Float4* position, const Springs& springs,
                  uint32_t begin, uint32_t end, Float3s force) {
  const FloatTag d;
  const Floats alpha = hn::Set(d, springs.alpha);
  for (uint32_t v = begin; v < end; v += kLanes) {
    const Floats valence = load_valence(ring, v);
    SpringSum walk{load_packed(position + v), hn::Set(d, springs.rest_length),
                   spread(springs.metric)};
    walk_ring(ring, position, v, valence, walk);
    if (HWY_UNLIKELY(has_tails(valence))) {
      walk.sum = with_tails(ring, v, walk.sum, [&](uint32_t u) {
        return scalar::spring_sum(ring, position, springs.rest_length, springs.metric, u);
      });
    }
    store3(load3(force, v) + walk.sum * alpha, force, v);
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

// Of a sum whose ring was walked.
HWY_INLINE Floats3 normal_of(const RingView& ring, const Float4* position, uint32_t v,
                             Floats valence, const NormalSum& walk) {
  const FloatTag d;
  Floats3 sum = walk.sum + cross(walk.last, walk.first);
  if (HWY_UNLIKELY(has_tails(valence))) {
    sum =
        with_tails(ring, v, sum, [&](uint32_t u) { return scalar::normal_sum(ring, position, u); });
  }
  const Floats length = hn::Sqrt(dot(sum, sum));
  const FloatMask some = hn::Gt(length, hn::Zero(d));
  return sum * hn::IfThenElseZero(some, hn::Div(hn::Set(d, 1.0F), length));
}

void normals(const RingView& ring, const Float4* position, const Blocks& blocks, Float3s normal) {
  for_lanes(ring, position, blocks, [&](uint32_t v) HWY_ATTR {
    const Floats valence = load_valence(ring, v);
    NormalSum walk{load_packed(position + v)};
    walk_ring(ring, position, v, valence, walk);
    store3(normal_of(ring, position, v, valence, walk), normal, v);
  });
}

// With a constructor: as an aggregate GCC 12 clears all of it first.
struct NormalAndDifferenceSum : NormalSum {
  Floats3 differences = zero3();
  HWY_INLINE explicit NormalAndDifferenceSum(const Floats3& vertex) : NormalSum{vertex} {}
  HWY_INLINE void add(FloatMask has_slot, const Floats3& neighbour) {
    differences = differences + (neighbour - centre);  // +0 past the valence
    NormalSum::add(has_slot, neighbour);
  }
};

void normals_and_laplacian(const RingView& ring, const Float4* position, const Blocks& blocks,
                           Float3s normal, Float4* laplacian) {
  for_lanes(ring, position, blocks, [&](uint32_t v) HWY_ATTR {
    const Floats valence = load_valence(ring, v);
    NormalAndDifferenceSum walk(load_packed(position + v));
    walk_ring(ring, position, v, valence, walk);
    if (HWY_UNLIKELY(has_tails(valence))) {
      walk.differences = with_tails(ring, v, walk.differences, [&](uint32_t u) {
        return scalar::difference_sum(ring, position, u);
      });
    }
    store3(normal_of(ring, position, v, valence, walk), normal, v);
    store_packed(walk.differences * inverse_valence(valence), laplacian + v);
  });
}

void metric_normals(const Metric& metric, ConstFloat3s normal, uint32_t begin, uint32_t end,
                    Float3s stretched, Float3s step) {
  const FloatTag d;
  const Floats one = hn::Set(d, 1.0F);
  const Floats3 lengths = spread(metric);
  const Floats3 inverse{hn::Div(one, lengths.x), hn::Div(one, lengths.y), hn::Div(one, lengths.z)};
  for (uint32_t v = begin; v < end; v += kLanes) {
    const Floats3 k = scaled(load3(normal, v), inverse);
    const Floats length = hn::Sqrt(dot(k, k));
    const FloatMask some = hn::Gt(length, hn::Zero(d));
    const Floats3 m = k * hn::IfThenElseZero(some, hn::Div(one, length));
    store3(m, stretched, v);
    store3(scaled(m, inverse), step, v);
  }
}

struct EdgeLimits {
  Floats3 centre;
  Floats above;
  Floats min_squared, max_squared;
  FloatMask too_short = hn::MaskFromVec(hn::Zero(FloatTag()));
  FloatMask too_long = too_short;
  HWY_INLINE void add(FloatMask has_slot, const Floats4& neighbour) {
    const FloatTag d;
    const Floats3 edge = Floats3{neighbour.x, neighbour.y, neighbour.z} - centre;
    const Floats length = dot(edge, edge);
    const Floats size =
        hn::Add(hn::Set(d, 1.0F), hn::Mul(hn::Set(d, 0.5F), hn::Add(above, neighbour.w)));
    const Floats squared = hn::Mul(size, size);
    too_short = hn::Or(too_short, hn::And(has_slot, hn::Le(length, hn::Mul(min_squared, squared))));
    too_long = hn::Or(too_long, hn::And(has_slot, hn::Ge(length, hn::Mul(max_squared, squared))));
  }
};

void edge_violations(const RingView& ring, const Float4* position, float min_squared,
                     float max_squared, const Blocks& blocks, uint8_t* flags) {
  const FloatTag d;
  const hn::RebindToSigned<FloatTag> d32;
  const hn::Rebind<uint8_t, FloatTag> d8;
  for_lanes(ring, position, blocks, [&](uint32_t v) HWY_ATTR {
    const Floats valence = load_valence(ring, v);
    const Floats4 own = load_packed4(position + v);
    EdgeLimits walk{{own.x, own.y, own.z}, own.w, hn::Set(d, min_squared), hn::Set(d, max_squared)};
    walk_ring4(ring, position, v, valence, walk);
    const auto bits =
        hn::Or(hn::IfThenElseZero(hn::RebindMask(d32, walk.too_short), hn::Set(d32, 1)),
               hn::IfThenElseZero(hn::RebindMask(d32, walk.too_long), hn::Set(d32, 2)));
    hn::StoreU(hn::DemoteTo(d8, bits), d8, flags + v);
    if (HWY_LIKELY(!has_tails(valence))) return;
    for (uint32_t u = v; u < v + kLanes; ++u) {
      if (ring.valence[u] <= kRingSlots) continue;
      flags[u] = scalar::violation_flags(ring, position, min_squared, max_squared, u);
    }
  });
}

struct TurnedFaces {
  Floats3 centre, normal;
  Floats most_squared;
  Floats3 first = zero3(), last = zero3();
  FloatMask turned = hn::MaskFromVec(hn::Zero(FloatTag()));
  bool started = false;
  HWY_INLINE void add(FloatMask has_slot, const Floats3& neighbour) {
    const Floats3 edge = neighbour - centre;
    if (!started) {
      first = last = edge;
      started = true;
      return;
    }
    test(has_slot, edge);
    last.x = hn::IfThenElse(has_slot, edge.x, last.x);
    last.y = hn::IfThenElse(has_slot, edge.y, last.y);
    last.z = hn::IfThenElse(has_slot, edge.z, last.z);
  }
  HWY_INLINE void test(FloatMask has_face, const Floats3& edge) {
    const FloatTag d;
    const Floats3 area = cross(last, edge);
    const Floats along = dot(area, normal);
    const FloatMask away = hn::Le(along, hn::Zero(d));
    const FloatMask far = hn::Le(hn::Mul(along, along), hn::Mul(most_squared, dot(area, area)));
    turned = hn::Or(turned, hn::And(has_face, hn::Or(away, far)));
  }
};

void turned_faces(const RingView& ring, const Float4* position, const Blocks& blocks,
                  ConstFloat3s normal, float most, uint8_t* flags) {
  const FloatTag d;
  const hn::RebindToSigned<FloatTag> d32;
  const hn::Rebind<uint8_t, FloatTag> d8;
  for_lanes(ring, position, blocks, [&](uint32_t v) HWY_ATTR {
    const Floats valence = load_valence(ring, v);
    TurnedFaces walk{load_packed(position + v), load3(normal, v), hn::Set(d, most * most)};
    walk_ring(ring, position, v, valence, walk);
    walk.test(hn::Gt(valence, hn::Zero(d)), walk.first);
    const auto bits = hn::IfThenElseZero(hn::RebindMask(d32, walk.turned), hn::Set(d32, 1));
    hn::StoreU(hn::DemoteTo(d8, bits), d8, flags + v);
    if (HWY_LIKELY(!has_tails(valence))) return;
    for (uint32_t u = v; u < v + kLanes; ++u) {
      if (ring.valence[u] <= kRingSlots) continue;
      flags[u] =
          scalar::turned_flag(ring, position, {normal.x[u], normal.y[u], normal.z[u]}, most, u);
    }
  });
}

struct LengthSum {
  Floats3 centre;
  Floats3 metric;
  Floats sum = hn::Zero(FloatTag());
  HWY_INLINE void add(FloatMask has_slot, const Floats3& neighbour) {
    sum = hn::Add(sum, hn::IfThenElseZero(has_slot, length_in(metric, neighbour - centre)));
  }
};

double edge_length_sum(const RingView& ring, const Float4* position, const Metric& metric,
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
HWY_EXPORT(normals_and_laplacian);
HWY_EXPORT(metric_normals);
HWY_EXPORT(edge_violations);
HWY_EXPORT(turned_faces);
HWY_EXPORT(edge_length_sum);

void laplacian(SimdTarget simd, const RingView& ring, const Float4* position, const Blocks& blocks,
               Float4* laplacian) {
  PLC_DISPATCH(simd, laplacian)(ring, position, blocks, laplacian);
}

void curvature_force(SimdTarget simd, const RingView& ring, const Float4* laplacian, float alpha_c,
                     uint32_t begin, uint32_t end, Float3s force) {
  PLC_DISPATCH(simd, curvature_force)(ring, laplacian, alpha_c, begin, end, force);
}

void spring_force(SimdTarget simd, const RingView& ring, const Float4* position,
                  const Springs& springs, uint32_t begin, uint32_t end, Float3s force) {
  PLC_DISPATCH(simd, spring_force)
  (ring, position, springs, begin, end, force);
}

void normals(SimdTarget simd, const RingView& ring, const Float4* position, const Blocks& blocks,
             Float3s normal) {
  PLC_DISPATCH(simd, normals)(ring, position, blocks, normal);
}

void normals_and_laplacian(SimdTarget simd, const RingView& ring, const Float4* position,
                           const Blocks& blocks, Float3s normal, Float4* laplacian) {
  PLC_DISPATCH(simd, normals_and_laplacian)(ring, position, blocks, normal, laplacian);
}

void metric_normals(SimdTarget simd, const Metric& metric, ConstFloat3s normal, uint32_t begin,
                    uint32_t end, Float3s stretched, Float3s step) {
  PLC_DISPATCH(simd, metric_normals)
  (metric, normal, begin, end, stretched, step);
}

void edge_violations(SimdTarget simd, const RingView& ring, const Float4* position,
                     float min_squared, float max_squared, const Blocks& blocks, uint8_t* flags) {
  PLC_DISPATCH(simd, edge_violations)(ring, position, min_squared, max_squared, blocks, flags);
}

void turned_faces(SimdTarget simd, const RingView& ring, const Float4* position,
                  const Blocks& blocks, ConstFloat3s normal, float most, uint8_t* flags) {
  PLC_DISPATCH(simd, turned_faces)(ring, position, blocks, normal, most, flags);
}

double edge_length_sum(SimdTarget simd, const RingView& ring, const Float4* position,
                       const Metric& metric, uint32_t begin, uint32_t end) {
  return PLC_DISPATCH(simd, edge_length_sum)(ring, position, metric, begin, end);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
