#include "kernels/separable.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/separable.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::reduce_x;
using scalar::reduce_y;
using scalar::reduce_z;
#else

// Values column .. column + 3 of each row.
struct RowQuads {
  const float* const* row;
  size_t column;
  HWY_INLINE Quad operator()(uint32_t lane) const {
    return hn::LoadU(QuadTag(), row[lane] + column);
  }
};

// Columns of up to kLanes rows from the first on: value c of row l goes to columns[c * kLanes + l].
// Lanes past the last row repeat it.
HWY_INLINE void transpose_rows(const ConstRows& in, size_t first, size_t rows, float* columns) {
  const size_t width = in.width;
  const FloatTag d;
  const float* row[kLanes];
  for (size_t l = 0; l < kLanes; ++l) {
    row[l] = in.values + (first + std::min(l, rows - 1)) * in.stride;
  }
  if (width < 4) {
    for (size_t c = 0; c < width; ++c) {
      for (size_t l = 0; l < kLanes; ++l) columns[c * kLanes + l] = row[l][c];
    }
    return;
  }
  for (size_t next = 0; next < width; next += 4) {
    const size_t c = std::min(next, width - 4);  // the last four may overlap: nothing is read past
    const Floats4 four = load_transposed(RowQuads{row, c});
    hn::Store(four.x, d, columns + c * kLanes);
    hn::Store(four.y, d, columns + (c + 1) * kLanes);
    hn::Store(four.z, d, columns + (c + 2) * kLanes);
    hn::Store(four.w, d, columns + (c + 3) * kLanes);
  }
}

template <int32_t kTaps>
HWY_INLINE Floats sum_columns(const float* weights, const float* columns) {
  const FloatTag d;
  Floats sum = hn::Mul(hn::Set(d, weights[0]), hn::Load(d, columns));
  for (int32_t k = 1; k < kTaps; ++k) {
    const Floats column = hn::Load(d, columns + static_cast<uint32_t>(k) * kLanes);
    sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), column));
  }
  return sum;
}

// Lanes are rows, so that the irregular places of the taps are the same for all lanes.
template <int32_t kTaps>
void reduce_x_taps(const TapsView& taps, const float* columns, size_t rows, Rows out) {
  const size_t outputs = out.width;
  const FloatTag d;
  const QuadTag d4;
  for (size_t i = 0; i < outputs; i += 4) {
    const size_t count = std::min<size_t>(4, outputs - i);
    alignas(64) float quad[4 * kLanes];
    Floats sum[4] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (size_t o = 0; o < count; ++o) {
      sum[o] = sum_columns<kTaps>(taps.weights + (i + o) * kTaps,
                                  columns + static_cast<size_t>(taps.first[i + o]) * kLanes);
    }
    hn::StoreInterleaved4(sum[0], sum[1], sum[2], sum[3], d, quad);
    for (size_t r = 0; r < rows; ++r) {
      if (count == 4) {
        hn::StoreU(hn::Load(d4, quad + 4 * r), d4, out.values + r * out.stride + i);
      } else {
        std::copy_n(quad + 4 * r, count, out.values + r * out.stride + i);
      }
    }
  }
}

void reduce_x(const TapsView& taps, const ConstRows& in, size_t rows, const Rows& out,
              float* scratch) {
  for (size_t r = 0; r < rows; r += kLanes) {
    const size_t some = std::min<size_t>(kLanes, rows - r);
    const Rows to{out.values + r * out.stride, out.width, out.stride};
    transpose_rows(in, r, some, scratch);
    switch (taps.taps) {
      case 1:
        reduce_x_taps<1>(taps, scratch, some, to);
        break;
      case 2:
        reduce_x_taps<2>(taps, scratch, some, to);
        break;
      case 3:
        reduce_x_taps<3>(taps, scratch, some, to);
        break;
      case 4:
        reduce_x_taps<4>(taps, scratch, some, to);
        break;
      case 5:
        reduce_x_taps<5>(taps, scratch, some, to);
        break;
      default:
        reduce_x_taps<6>(taps, scratch, some, to);
        break;
    }
  }
}

// out[i] = sum over k of weights[k] * rows[k][i], limited to 1 if asked.
template <int32_t kTaps, bool kLimit>
void sum_rows_taps(const float* weights, const float* const* rows, size_t count, float* out) {
  const FloatTag d;
  const Floats one = hn::Set(d, 1.0F);
  const size_t whole = count - count % kLanes;
  const float* row[kTaps];
  for (int32_t k = 0; k < kTaps; ++k) row[k] = rows[k];
  for (size_t i = 0; i < whole; i += kLanes) {
    Floats sum = hn::Mul(hn::Set(d, weights[0]), hn::LoadU(d, row[0] + i));
    for (int32_t k = 1; k < kTaps; ++k) {
      sum = hn::Add(sum, hn::Mul(hn::Set(d, weights[k]), hn::LoadU(d, row[k] + i)));
    }
    if constexpr (kLimit) sum = hn::IfThenElse(hn::Lt(sum, one), sum, one);
    hn::StoreU(sum, d, out + i);
  }
  for (size_t i = whole; i < count; ++i) {
    float sum = weights[0] * row[0][i];
    for (int32_t k = 1; k < kTaps; ++k) sum += weights[k] * row[k][i];
    out[i] = !kLimit || sum < 1.0F ? sum : 1.0F;
  }
}

template <bool kLimit>
HWY_INLINE void sum_rows(const float* weights, int32_t taps, const float* const* rows, size_t count,
                         float* out) {
  switch (taps) {
    case 1:
      return sum_rows_taps<1, kLimit>(weights, rows, count, out);
    case 2:
      return sum_rows_taps<2, kLimit>(weights, rows, count, out);
    case 3:
      return sum_rows_taps<3, kLimit>(weights, rows, count, out);
    case 4:
      return sum_rows_taps<4, kLimit>(weights, rows, count, out);
    case 5:
      return sum_rows_taps<5, kLimit>(weights, rows, count, out);
    default:
      return sum_rows_taps<6, kLimit>(weights, rows, count, out);
  }
}

void reduce_y(const TapsView& taps, size_t begin, size_t end, const ConstRows& in,
              const Rows& out) {
  for (size_t j = begin; j < end; ++j) {
    const float* rows[kMaxTaps];
    for (int32_t k = 0; k < taps.taps; ++k) {
      rows[k] = in.values + static_cast<size_t>(taps.first[j] - taps.first[begin] + k) * in.stride;
    }
    sum_rows<false>(taps.weights + j * static_cast<size_t>(taps.taps), taps.taps, rows, in.width,
                    out.values + (j - begin) * out.stride);
  }
}

void reduce_z(const float* weights, int32_t taps, const float* const* planes, size_t count,
              float* out) {
  sum_rows<true>(weights, taps, planes, count, out);
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(reduce_x);
HWY_EXPORT(reduce_y);
HWY_EXPORT(reduce_z);

void reduce_x(SimdTarget simd, const TapsView& taps, const ConstRows& in, size_t rows,
              const Rows& out, float* scratch) {
  PLC_DISPATCH(simd, reduce_x)
  (taps, in, rows, out, scratch);
}

void reduce_y(SimdTarget simd, const TapsView& taps, size_t begin, size_t end, const ConstRows& in,
              const Rows& out) {
  PLC_DISPATCH(simd, reduce_y)(taps, begin, end, in, out);
}

void reduce_z(SimdTarget simd, const float* weights, int32_t taps, const float* const* planes,
              size_t count, float* out) {
  PLC_DISPATCH(simd, reduce_z)(weights, taps, planes, count, out);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
