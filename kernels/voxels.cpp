#include "kernels/voxels.h"

#include <algorithm>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/voxels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::normalize_voxels;
using scalar::voxel_extent;
#else

#if HWY_TARGET == HWY_WASM  // Highway has no vectors of doubles there before its version 1.0.4
using scalar::normalize_voxels;
#else

// As many voxels as a vector holds doubles.
using DoubleTag = hn::ScalableTag<double>;
using Doubles = hn::Vec<DoubleTag>;

template <typename T>
HWY_INLINE Doubles load_doubles(const T* voxels) {
  const DoubleTag d;
  const hn::Rebind<int32_t, DoubleTag> d32;
  const hn::Rebind<T, DoubleTag> d_own;
  if constexpr (sizeof(T) == 4) {
    return hn::PromoteTo(d, hn::LoadU(d_own, voxels));
  } else {
    return hn::PromoteTo(d, hn::PromoteTo(d32, hn::LoadU(d_own, voxels)));
  }
}

template <typename T>
HWY_INLINE void normalize(VoxelType type, const T* voxels, size_t count, double low, double scale,
                          float* values) {
  const DoubleTag d;
  const hn::Rebind<float, DoubleTag> df;
  const Doubles one = hn::Set(d, 1.0);
  const size_t whole = count - count % hn::MaxLanes(d);
  for (size_t i = 0; i < whole; i += hn::MaxLanes(d)) {
    Doubles t = hn::Mul(hn::Sub(load_doubles(voxels + i), hn::Set(d, low)), hn::Set(d, scale));
    t = hn::IfThenElseZero(hn::Gt(t, hn::Zero(d)), t);
    t = hn::IfThenElse(hn::Lt(t, one), t, one);
    hn::StoreU(hn::DemoteTo(df, t), df, values + i);
  }
  scalar::normalize_voxels(type, voxels + whole, count - whole, low, scale, values + whole);
}

void normalize_voxels(VoxelType type, const void* voxels, size_t count, double low, double scale,
                      float* values) {
  switch (type) {
    case VoxelType::kU8:
      return normalize(type, static_cast<const uint8_t*>(voxels), count, low, scale, values);
    case VoxelType::kI16:
      return normalize(type, static_cast<const int16_t*>(voxels), count, low, scale, values);
    case VoxelType::kU16:
      return normalize(type, static_cast<const uint16_t*>(voxels), count, low, scale, values);
    case VoxelType::kI32:
      return normalize(type, static_cast<const int32_t*>(voxels), count, low, scale, values);
    case VoxelType::kF32:
      return normalize(type, static_cast<const float*>(voxels), count, low, scale, values);
  }
}
#endif

// Lane extremes of whole vectors, then the rest by the scalar twin.
template <typename T>
HWY_INLINE VoxelExtent extent(VoxelType type, const T* voxels, size_t count) {
  const hn::ScalableTag<T> d;
  const size_t lanes = hn::MaxLanes(d);
  const size_t whole = count - count % lanes;
  auto low = hn::Set(d, std::numeric_limits<T>::max());
  auto high = hn::Set(d, std::numeric_limits<T>::lowest());
  size_t not_finite = 0;
  for (size_t i = 0; i < whole; i += lanes) {
    const auto v = hn::LoadU(d, voxels + i);
    if constexpr (std::numeric_limits<T>::has_infinity) {
      const auto finite = hn::Le(hn::Abs(v), hn::Set(d, std::numeric_limits<T>::max()));
      not_finite += lanes - hn::CountTrue(d, finite);
      low = hn::IfThenElse(hn::And(finite, hn::Lt(v, low)), v, low);
      high = hn::IfThenElse(hn::And(finite, hn::Gt(v, high)), v, high);
    } else {
      low = hn::Min(low, v);
      high = hn::Max(high, v);
    }
  }
  VoxelExtent result = scalar::voxel_extent(type, voxels + whole, count - whole);
  result.not_finite += not_finite;
  if (whole == not_finite) return result;
  alignas(64) T lows[hn::MaxLanes(d)];
  alignas(64) T highs[hn::MaxLanes(d)];
  hn::Store(low, d, lows);
  hn::Store(high, d, highs);
  const VoxelExtent body{static_cast<double>(*std::min_element(lows, lows + lanes)) + 0.0,
                         static_cast<double>(*std::max_element(highs, highs + lanes)) + 0.0, 0};
  const bool tail_is_empty = result.not_finite - not_finite == count - whole;
  result.low = tail_is_empty ? body.low : std::min(result.low, body.low);
  result.high = tail_is_empty ? body.high : std::max(result.high, body.high);
  return result;
}

VoxelExtent voxel_extent(VoxelType type, const void* voxels, size_t count) {
  switch (type) {
    case VoxelType::kU8:
      return extent(type, static_cast<const uint8_t*>(voxels), count);
    case VoxelType::kI16:
      return extent(type, static_cast<const int16_t*>(voxels), count);
    case VoxelType::kU16:
      return extent(type, static_cast<const uint16_t*>(voxels), count);
    case VoxelType::kI32:
      return extent(type, static_cast<const int32_t*>(voxels), count);
    case VoxelType::kF32:
      return extent(type, static_cast<const float*>(voxels), count);
  }
  return {};
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(normalize_voxels);
HWY_EXPORT(voxel_extent);

void normalize_voxels(SimdTarget simd, VoxelType type, const void* voxels, size_t count, double low,
                      double scale, float* values) {
  PLC_DISPATCH(simd, normalize_voxels)(type, voxels, count, low, scale, values);
}

VoxelExtent voxel_extent(SimdTarget simd, VoxelType type, const void* voxels, size_t count) {
  return PLC_DISPATCH(simd, voxel_extent)(type, voxels, count);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
