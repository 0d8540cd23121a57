#include "kernels/sobel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/sobel.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/dispatch.h"
#include "kernels/scalar.h"
#include "kernels/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plc::kernels {
namespace HWY_NAMESPACE {

#if PLC_SCALAR_TARGET
using scalar::bound_vectors;
using scalar::sobel;
using scalar::vector_norms;
#else

// a + 2 b + c
HWY_INLINE Floats mean4(Floats a, Floats b, Floats c) {
  return hn::Add(hn::Add(a, c), hn::Add(b, b));
}

// The sums across rows and planes of each column, see the scalar twin.
HWY_INLINE void sum_columns(const float* const* rows, size_t whole, const SobelColumns& to) {
  const FloatTag d;
  for (size_t i = 0; i < whole; i += kLanes) {
    Floats3 mean = zero3(), difference = zero3();
    const auto sum_plane = [&](uint32_t k, Floats& plane_mean, Floats& plane_difference) {
      const Floats before = hn::LoadU(d, rows[3 * k] + i);
      const Floats after = hn::LoadU(d, rows[3 * k + 2] + i);
      plane_mean = mean4(before, hn::LoadU(d, rows[3 * k + 1] + i), after);
      plane_difference = hn::Sub(after, before);
    };
    sum_plane(0, mean.x, difference.x);
    sum_plane(1, mean.y, difference.y);
    sum_plane(2, mean.z, difference.z);
    hn::StoreU(mean4(mean.x, mean.y, mean.z), d, to.mean + 1 + i);
    hn::StoreU(mean4(difference.x, difference.y, difference.z), d, to.along_y + 1 + i);
    hn::StoreU(hn::Sub(mean.z, mean.x), d, to.along_z + 1 + i);
  }
}

void sobel(const float* const* rows, size_t width, const std::array<float, 3>& scale,
           float* scratch, float* gx, float* gy, float* gz) {
  const FloatTag d;
  const SobelColumns columns(scratch, width);
  const size_t whole = width - width % kLanes;
  sum_columns(rows, whole, columns);
  scalar::sobel_columns(rows, whole, width, columns);
  columns.repeat_ends(width);
  const Floats scale_x = hn::Set(d, scale[0] * kSobelNorm);
  const Floats scale_y = hn::Set(d, scale[1] * kSobelNorm);
  const Floats scale_z = hn::Set(d, scale[2] * kSobelNorm);
  const auto mean_of = [d](const float* at) {
    return mean4(hn::LoadU(d, at), hn::LoadU(d, at + 1), hn::LoadU(d, at + 2));
  };
  for (size_t i = 0; i < whole; i += kLanes) {
    const Floats along_x =
        hn::Sub(hn::LoadU(d, columns.mean + i + 2), hn::LoadU(d, columns.mean + i));
    hn::StoreU(hn::Mul(scale_x, along_x), d, gx + i);
    hn::StoreU(hn::Mul(scale_y, mean_of(columns.along_y + i)), d, gy + i);
    hn::StoreU(hn::Mul(scale_z, mean_of(columns.along_z + i)), d, gz + i);
  }
  scalar::sobel_row(columns, whole, width, scale, gx, gy, gz);
}

HWY_INLINE Floats length(const float* gx, const float* gy, const float* gz, size_t i) {
  const FloatTag d;
  const Floats3 g{hn::LoadU(d, gx + i), hn::LoadU(d, gy + i), hn::LoadU(d, gz + i)};
  return hn::Sqrt(dot(g, g));
}

void bound_vectors(const float* gx, const float* gy, const float* gz, size_t count, float bound,
                   Float4* vectors) {
  const FloatTag d;
  const Floats most = hn::Set(d, bound);
  const size_t whole = count - count % kLanes;
  for (size_t i = 0; i < whole; i += kLanes) {
    const Floats own = length(gx, gy, gz, i);
    const Floats divisor = hn::IfThenElse(hn::Gt(own, most), own, most);
    store_packed({hn::Div(hn::LoadU(d, gx + i), divisor), hn::Div(hn::LoadU(d, gy + i), divisor),
                  hn::Div(hn::LoadU(d, gz + i), divisor)},
                 vectors + i);
  }
  scalar::bound_vectors(gx + whole, gy + whole, gz + whole, count - whole, bound, vectors + whole);
}

void vector_norms(const float* gx, const float* gy, const float* gz, size_t count, float factor,
                  float* norms) {
  const FloatTag d;
  const size_t whole = count - count % kLanes;
  for (size_t i = 0; i < whole; i += kLanes) {
    hn::StoreU(hn::Mul(hn::Set(d, factor), length(gx, gy, gz, i)), d, norms + i);
  }
  scalar::vector_norms(gx + whole, gy + whole, gz + whole, count - whole, factor, norms + whole);
}

#endif  // PLC_SCALAR_TARGET

}  // namespace HWY_NAMESPACE
}  // namespace plc::kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plc::kernels {

HWY_EXPORT(sobel);
HWY_EXPORT(bound_vectors);
HWY_EXPORT(vector_norms);

void sobel(SimdTarget simd, const float* const* rows, size_t width,
           const std::array<float, 3>& scale, float* scratch, float* gx, float* gy, float* gz) {
  PLC_DISPATCH(simd, sobel)(rows, width, scale, scratch, gx, gy, gz);
}

void bound_vectors(SimdTarget simd, const float* gx, const float* gy, const float* gz, size_t count,
                   float bound, Float4* vectors) {
  PLC_DISPATCH(simd, bound_vectors)(gx, gy, gz, count, bound, vectors);
}

void vector_norms(SimdTarget simd, const float* gx, const float* gy, const float* gz, size_t count,
                  float factor, float* norms) {
  PLC_DISPATCH(simd, vector_norms)(gx, gy, gz, count, factor, norms);
}

}  // namespace plc::kernels
#endif  // HWY_ONCE
