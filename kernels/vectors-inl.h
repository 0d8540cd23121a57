// What the vector kernels share: three-component vectors, and records fetched by index.
// Included once per target, after hwy/foreach_target.h.
#if defined(PELLICLE_KERNELS_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef PELLICLE_KERNELS_VECTORS_INL_H
#undef PELLICLE_KERNELS_VECTORS_INL_H
#else
#define PELLICLE_KERNELS_VECTORS_INL_H
#endif

#include "hwy/highway.h"
#include "kernels/float3s.h"
#include "kernels/ring.h"

// The target without vectors, which Highway always compiles as the last resort: there the kernels
// are their scalar twins.
#undef PLC_SCALAR_TARGET
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
#define PLC_SCALAR_TARGET 1
#else
#define PLC_SCALAR_TARGET 0

HWY_BEFORE_NAMESPACE();
namespace plc::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using Floats = hn::Vec<FloatTag>;
using FloatMask = hn::Mask<FloatTag>;
inline constexpr uint32_t kLanes = static_cast<uint32_t>(hn::MaxLanes(FloatTag()));
static_assert(kRingLanes % kLanes == 0, "a block of vertices is a whole number of vectors");

// Copied member by member: a plain aggregate GCC 12 copies through memory in 16-byte pieces
// (normals on AVX2: 8.0 ns per vertex, this way 6.6).
struct Floats3 {
  Floats x, y, z;
  HWY_INLINE Floats3(Floats x_value, Floats y_value, Floats z_value)
      : x(x_value), y(y_value), z(z_value) {}
  HWY_INLINE Floats3(const Floats3& other) : x(other.x), y(other.y), z(other.z) {}
  HWY_INLINE Floats3& operator=(const Floats3& other) {
    x = other.x;
    y = other.y;
    z = other.z;
    return *this;
  }
};

// Every operation of these rounds once, in the order written; no fused multiply-add anywhere.
HWY_INLINE Floats3 operator+(const Floats3& a, const Floats3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Floats3 operator-(const Floats3& a, const Floats3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Floats3 operator*(const Floats3& a, Floats s) {
  return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
HWY_INLINE Floats dot(const Floats3& a, const Floats3& b) {
  return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
HWY_INLINE Floats3 cross(const Floats3& a, const Floats3& b) {
  return {hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
          hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
          hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}
// a where the mask is set, +0 elsewhere. Sums that start at +0 never are -0, so adding the +0 of
// an absent term changes no bit.
HWY_INLINE Floats3 where(FloatMask mask, const Floats3& a) {
  return {hn::IfThenElseZero(mask, a.x), hn::IfThenElseZero(mask, a.y),
          hn::IfThenElseZero(mask, a.z)};
}
HWY_INLINE Floats3 zero3() {
  const FloatTag d;
  return {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
}

HWY_INLINE Floats3 load3(const float* x, const float* y, const float* z, uint32_t i) {
  const FloatTag d;
  return {hn::LoadU(d, x + i), hn::LoadU(d, y + i), hn::LoadU(d, z + i)};
}
HWY_INLINE void store3(const Floats3& a, float* x, float* y, float* z, uint32_t i) {
  const FloatTag d;
  hn::StoreU(a.x, d, x + i);
  hn::StoreU(a.y, d, y + i);
  hn::StoreU(a.z, d, z + i);
}
template <class Streams>
HWY_INLINE Floats3 load3(const Streams& s, uint32_t i) {
  return load3(s.x, s.y, s.z, i);
}
HWY_INLINE void store3(const Floats3& a, const Float3s& s, uint32_t i) {
  store3(a, s.x, s.y, s.z, i);
}
HWY_INLINE void store_packed(const Floats3& a, Floats w, Float4* to) {
  hn::StoreInterleaved4(a.x, a.y, a.z, w, FloatTag(), &to->x);
}
HWY_INLINE void store_packed(const Floats3& a, Float4* to) {
  store_packed(a, hn::Zero(FloatTag()), to);
}

// 16-byte block b of the result is load(lane + 4 b).
template <class D, class Load>
HWY_INLINE hn::Vec<D> load_blocks(D d, const Load& load, uint32_t lane) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return load(lane);
  } else {
    const hn::Half<D> half;
    constexpr uint32_t kHalf = static_cast<uint32_t>(hn::MaxLanes(half));
    return hn::Combine(d, load_blocks(half, load, lane + kHalf), load_blocks(half, load, lane));
  }
}

using QuadTag = hn::CappedTag<float, 4>;
using Quad = hn::Vec<QuadTag>;

// One record of four floats per lane, as they are loaded: vector i holds the records of lanes i,
// i + 4, ...
struct Records {
  Floats a, b, c, e;
};
// load(lane) is the record of a lane.
template <class Load>
HWY_INLINE Records load_records(const Load& load) {
  const FloatTag d;
  return {load_blocks(d, load, 0), load_blocks(d, load, 1), load_blocks(d, load, 2),
          load_blocks(d, load, 3)};
}

// Transposes records: field f of the record of lane l goes to lane l of the result f. One load per
// record and shuffles inside 16-byte blocks: half the cost of gathers.
struct Floats4 {
  Floats x, y, z, w;
};
HWY_INLINE Floats4 transposed(const Records& r) {
  const FloatTag d;
  const Floats ac_low = hn::InterleaveLower(d, r.a, r.c);   // a.x c.x a.y c.y
  const Floats be_low = hn::InterleaveLower(d, r.b, r.e);   // b.x e.x b.y e.y
  const Floats ac_high = hn::InterleaveUpper(d, r.a, r.c);  // a.z c.z a.w c.w
  const Floats be_high = hn::InterleaveUpper(d, r.b, r.e);
  return {hn::InterleaveLower(d, ac_low, be_low), hn::InterleaveUpper(d, ac_low, be_low),
          hn::InterleaveLower(d, ac_high, be_high), hn::InterleaveUpper(d, ac_high, be_high)};
}
HWY_INLINE Floats3 transposed3(const Records& records) {
  const Floats4 r = transposed(records);
  return {r.x, r.y, r.z};
}
template <class Load>
HWY_INLINE Floats4 load_transposed(const Load& load) {
  return transposed(load_records(load));
}

// Records index[0 .. N-1].
struct IndexedRecords {
  const Float4* record;
  const uint32_t* index;
  HWY_INLINE Quad operator()(uint32_t lane) const {
    return hn::Load(QuadTag(), &record[index[lane]].x);
  }
};
HWY_INLINE Floats4 load_indexed4(const Float4* record, const uint32_t* index) {
  return load_transposed(IndexedRecords{record, index});
}
HWY_INLINE Floats3 load_indexed(const Float4* record, const uint32_t* index) {
  const Floats4 r = load_transposed(IndexedRecords{record, index});
  return {r.x, r.y, r.z};
}

// Records at[0 .. N-1].
struct SuccessiveRecords {
  const Float4* at;
  HWY_INLINE Quad operator()(uint32_t lane) const { return hn::Load(QuadTag(), &at[lane].x); }
};
HWY_INLINE Floats4 load_packed4(const Float4* at) {
  return load_transposed(SuccessiveRecords{at});
}
HWY_INLINE Floats3 load_packed(const Float4* at) {
  const Floats4 r = load_transposed(SuccessiveRecords{at});
  return {r.x, r.y, r.z};
}

}  // namespace plc::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // PLC_SCALAR_TARGET
#endif  // include guard per target
