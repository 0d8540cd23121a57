// Sums over neighbour rings, lanes are vertices. Included once per target.
#if defined(PELLICLE_KERNELS_RING_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PELLICLE_KERNELS_RING_INL_H
#undef PELLICLE_KERNELS_RING_INL_H
#else
#define PELLICLE_KERNELS_RING_INL_H
#endif

#include "hwy/cache_control.h"
#include "kernels/prefetch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

#if !PLC_SCALAR_TARGET
HWY_BEFORE_NAMESPACE();
namespace plc::kernels::HWY_NAMESPACE {

// Lanes are vertices v .. v + kLanes - 1.
HWY_INLINE Floats load_valence(const RingView& ring, uint32_t v) {
  const hn::Rebind<uint16_t, FloatTag> d16;
  const hn::RebindToSigned<FloatTag> d32;
  return hn::ConvertTo(FloatTag(), hn::PromoteTo(d32, hn::LoadU(d16, ring.valence + v)));
}

HWY_INLINE const uint32_t* columns_of(const RingView& ring, uint32_t v) {
  return ring.columns + size_t{v / kRingLanes} * kRingColumns * kRingLanes + v % kRingLanes;
}

// Loops over blocks fetch what the block this many later begins with into the second cache, which
// has more misses under way than the first; a task fetches for the next one (Blocks::following).
inline constexpr size_t kAhead = 96;
HWY_INLINE void prefetch(const void* p) {
  prefetch_far(p);
}
// The slots that most rings have.
HWY_INLINE void prefetch_ring(const RingView& ring, uint32_t begin) {
  const uint32_t* column = columns_of(ring, begin);
  for (uint32_t k = 0; k < 8; ++k) prefetch(column + k * kRingLanes);
  prefetch(ring.valence + begin);
}
HWY_INLINE void prefetch_records(const Float4* records, uint32_t begin) {
  for (uint32_t i = 0; i < kRingLanes; i += 4) prefetch(records + begin + i);
}

HWY_INLINE bool longer_than(Floats valence, uint32_t slots) {
  const FloatTag d;
  return !hn::AllFalse(d, hn::Gt(valence, hn::Set(d, static_cast<float>(slots))));
}

// Calls sum.add(mask of the lanes that have slot k, load(indices of slot k)) for k = 0 .. until no
// lane has more, or the columns end.
template <class Load, class Sum>
HWY_INLINE void walk_slots(const RingView& ring, uint32_t v, Floats valence, const Load& load,
                           Sum& sum) {
  const FloatTag d;
  const uint32_t* column = columns_of(ring, v);
  Floats slot = hn::Zero(d);
  for (uint32_t k = 0; k < kRingSlots; ++k, column += kRingLanes) {
    const FloatMask has_slot = hn::Lt(slot, valence);
    if (hn::AllFalse(d, has_slot)) return;
    sum.add(has_slot, load(column));
    slot = hn::Add(slot, hn::Set(d, 1.0F));
  }
}
// ... of the records' x, y, z; of their w, too.
template <class Sum>
HWY_INLINE void walk_ring(const RingView& ring, const Float4* record, uint32_t v, Floats valence,
                          Sum& sum) {
  walk_slots(
      ring, v, valence,
      [record](const uint32_t* index) HWY_ATTR { return load_indexed(record, index); }, sum);
}
template <class Sum>
HWY_INLINE void walk_ring4(const RingView& ring, const Float4* record, uint32_t v, Floats valence,
                           Sum& sum) {
  walk_slots(
      ring, v, valence,
      [record](const uint32_t* index) HWY_ATTR { return load_indexed4(record, index); }, sum);
}

HWY_INLINE bool has_tails(Floats valence) {
  return longer_than(valence, kRingSlots);
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

// Plain sums are taken over whole records and transposed once, at the end: a shuffle per slot less
// for each of three coordinates (laplacian on AVX2: 2.98 ns per vertex transposed slot by slot).
// Nearly every vertex has more than this many neighbours, or other lanes do.
inline constexpr uint32_t kCommonSlots = 6;

// Sum of y - x over the ring. Slots past the valence hold the vertex itself and add +0.
HWY_INLINE Floats3 difference_sum(const RingView& ring, const Float4* position, uint32_t v,
                                  Floats valence) {
  const FloatTag d;
  const Records centre = load_records(SuccessiveRecords{position + v});
  Records sum{hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  const uint32_t* column = columns_of(ring, v);
  const auto add = [&](const uint32_t* index) HWY_ATTR {
    const IndexedRecords r{position, index};
    sum.a = hn::Add(sum.a, hn::Sub(load_blocks(d, r, 0), centre.a));
    sum.b = hn::Add(sum.b, hn::Sub(load_blocks(d, r, 1), centre.b));
    sum.c = hn::Add(sum.c, hn::Sub(load_blocks(d, r, 2), centre.c));
    sum.e = hn::Add(sum.e, hn::Sub(load_blocks(d, r, 3), centre.e));
  };
  for (uint32_t k = 0; k < kCommonSlots; ++k) add(column + k * kRingLanes);
  for (uint32_t k = kCommonSlots; k < kRingSlots && longer_than(valence, k); ++k) {
    add(column + k * kRingLanes);
  }
  const Floats3 whole = transposed3(sum);
  if (HWY_LIKELY(!has_tails(valence))) return whole;
  return with_tails(ring, v, whole,
                    [&](uint32_t u) { return scalar::difference_sum(ring, position, u); });
}

// Sum of the records over the ring of every living vertex; records of deleted ones are 0. A living
// vertex has three neighbours at least.
HWY_INLINE Floats3 record_sum(const RingView& ring, const Float4* record, uint32_t v,
                              Floats valence) {
  const FloatTag d;
  Records sum{hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  const uint32_t* column = columns_of(ring, v);
  // Lane l of the valences for every field of the record of lane l.
  const Records slots{hn::Broadcast<0>(valence), hn::Broadcast<1>(valence),
                      hn::Broadcast<2>(valence), hn::Broadcast<3>(valence)};
  const auto add = [&](const uint32_t* index) HWY_ATTR {
    const IndexedRecords r{record, index};
    sum.a = hn::Add(sum.a, load_blocks(d, r, 0));
    sum.b = hn::Add(sum.b, load_blocks(d, r, 1));
    sum.c = hn::Add(sum.c, load_blocks(d, r, 2));
    sum.e = hn::Add(sum.e, load_blocks(d, r, 3));
  };
  const auto add_some = [&](const uint32_t* index, Floats slot) HWY_ATTR {
    const IndexedRecords r{record, index};
    sum.a = hn::Add(sum.a, hn::IfThenElseZero(hn::Lt(slot, slots.a), load_blocks(d, r, 0)));
    sum.b = hn::Add(sum.b, hn::IfThenElseZero(hn::Lt(slot, slots.b), load_blocks(d, r, 1)));
    sum.c = hn::Add(sum.c, hn::IfThenElseZero(hn::Lt(slot, slots.c), load_blocks(d, r, 2)));
    sum.e = hn::Add(sum.e, hn::IfThenElseZero(hn::Lt(slot, slots.e), load_blocks(d, r, 3)));
  };
  for (uint32_t k = 0; k < 3; ++k) add(column + k * kRingLanes);
  Floats slot = hn::Set(d, 3.0F);
  const Floats one = hn::Set(d, 1.0F);
  for (uint32_t k = 3; k < kCommonSlots; ++k, slot = hn::Add(slot, one)) {
    add_some(column + k * kRingLanes, slot);
  }
  for (uint32_t k = kCommonSlots; k < kRingSlots && longer_than(valence, k); ++k) {
    add_some(column + k * kRingLanes, slot);
    slot = hn::Add(slot, one);
  }
  const Floats3 whole = transposed3(sum);
  if (HWY_LIKELY(!has_tails(valence))) return whole;
  return with_tails(ring, v, whole,
                    [&](uint32_t u) { return scalar::record_sum(ring, record, u); });
}

}  // namespace plc::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#endif  // include guard per target
