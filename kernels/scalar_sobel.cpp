// Scalar twins of kernels/sobel.h and weighted_rows.h.
#include <cmath>

#include "kernels/scalar.h"

namespace plc::kernels::scalar {

namespace {

// a + 2 b + c
float mean4(float a, float b, float c) {
  return (a + c) + (b + b);
}

float length(float x, float y, float z) {
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace

void sobel_columns(const float* const* rows, size_t begin, size_t end, const SobelColumns& to) {
  for (size_t i = begin; i < end; ++i) {
    float mean[3], difference[3];
    for (size_t k = 0; k < 3; ++k) {
      const float before = rows[3 * k][i];
      const float after = rows[3 * k + 2][i];
      mean[k] = mean4(before, rows[3 * k + 1][i], after);
      difference[k] = after - before;
    }
    to.mean[i + 1] = mean4(mean[0], mean[1], mean[2]);
    to.along_y[i + 1] = mean4(difference[0], difference[1], difference[2]);
    to.along_z[i + 1] = mean[2] - mean[0];
  }
}

void sobel_row(const SobelColumns& columns, size_t begin, size_t end,
               const std::array<float, 3>& scale, float* gx, float* gy, float* gz) {
  const auto mean_of = [](const float* at) { return mean4(at[0], at[1], at[2]); };
  for (size_t i = begin; i < end; ++i) {
    gx[i] = scale[0] * kSobelNorm * (columns.mean[i + 2] - columns.mean[i]);
    gy[i] = scale[1] * kSobelNorm * mean_of(columns.along_y + i);
    gz[i] = scale[2] * kSobelNorm * mean_of(columns.along_z + i);
  }
}

void sobel(const float* const* rows, size_t width, const std::array<float, 3>& scale,
           float* scratch, float* gx, float* gy, float* gz) {
  const SobelColumns columns(scratch, width);
  sobel_columns(rows, 0, width, columns);
  columns.repeat_ends(width);
  sobel_row(columns, 0, width, scale, gx, gy, gz);
}

void bound_vectors(const float* gx, const float* gy, const float* gz, size_t count, float bound,
                   Float4* vectors) {
  for (size_t i = 0; i < count; ++i) {
    const float own = length(gx[i], gy[i], gz[i]);
    const float divisor = own > bound ? own : bound;
    vectors[i] = {gx[i] / divisor, gy[i] / divisor, gz[i] / divisor, 0.0F};
  }
}

void vector_norms(const float* gx, const float* gy, const float* gz, size_t count, float factor,
                  float* norms) {
  for (size_t i = 0; i < count; ++i) norms[i] = factor * length(gx[i], gy[i], gz[i]);
}

void weighted_rows(const float* weights, size_t taps, const float* const* rows, size_t begin,
                   size_t end, float* out) {
  for (size_t i = begin; i < end; ++i) {
    float sum = weights[0] * rows[0][i];
    for (size_t k = 1; k < taps; ++k) sum += weights[k] * rows[k][i];
    out[i] = sum;
  }
}

}  // namespace plc::kernels::scalar
