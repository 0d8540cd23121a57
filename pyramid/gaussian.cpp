#include "pyramid/gaussian.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/weighted_rows.h"
#include "pyramid/buffer.h"
#include "pyramid/exponential.h"
#include "pyramid/guarded_run.h"

namespace plc {

namespace {

// Values of a plane that one task takes through all planes: with a radius of 6 its window of 13
// planes takes 208 KB, which stays in a core's second-level cache.
constexpr size_t kColumnValues = 4096;

// One axis: weights, and the places that output i reads, replicated outside the axis.
struct AxisKernel {
  std::vector<float> weights;
  int64_t size;

  AxisKernel(double sigma, int64_t axis_size) : weights(gaussian_weights(sigma)), size(axis_size) {}
  size_t radius() const { return weights.size() / 2; }
  size_t input(size_t output, size_t k) const {
    const auto at = static_cast<int64_t>(output + k) - static_cast<int64_t>(radius());
    return static_cast<size_t>(std::clamp<int64_t>(at, 0, size - 1));
  }
};

// rows[k] = begin + step * (the place of input k of an output).
void rows_of(const AxisKernel& axis, size_t output, const float* begin, size_t step,
             std::vector<const float*>& rows) {
  rows.resize(axis.weights.size());
  for (size_t k = 0; k < rows.size(); ++k) rows[k] = begin + axis.input(output, k) * step;
}

// A plane in place, along X, then Y.
void convolve_plane(const AxisKernel& x, const AxisKernel& y, SimdTarget simd, float* plane) {
  const auto m = static_cast<size_t>(x.size);
  const auto n = static_cast<size_t>(y.size);
  Buffer<float> padded, along_x;
  padded.resize_uninitialized(m + 2 * x.radius());
  along_x.resize_uninitialized(m * n);
  std::vector<const float*> rows(x.weights.size());
  for (size_t k = 0; k < rows.size(); ++k) rows[k] = padded.data() + k;
  for (size_t j = 0; j < n; ++j) {
    const float* row = plane + j * m;
    std::fill_n(padded.data(), x.radius(), row[0]);
    std::copy_n(row, m, padded.data() + x.radius());
    std::fill_n(padded.data() + x.radius() + m, x.radius(), row[m - 1]);
    kernels::weighted_rows(simd, x.weights.data(), x.weights.size(), rows.data(), 0, m,
                           along_x.data() + j * m);
  }
  for (size_t j = 0; j < n; ++j) {
    rows_of(y, j, along_x.data(), m, rows);
    kernels::weighted_rows(simd, y.weights.data(), y.weights.size(), rows.data(), 0, m,
                           plane + j * m);
  }
}

}  // namespace

int64_t gaussian_radius(double sigma) {
  return static_cast<int64_t>(std::ceil(3.0 * sigma));
}

std::vector<float> gaussian_weights(double sigma) {
  const int64_t radius = gaussian_radius(sigma);
  std::vector<double> samples;
  double sum = 0;
  for (int64_t i = -radius; i <= radius; ++i) {
    const double place = i == 0 ? 0.0 : static_cast<double>(i) / sigma;
    samples.push_back(exponential(-0.5 * place * place));
    sum += samples.back();
  }
  std::vector<float> weights;
  weights.reserve(samples.size());
  for (const double sample : samples) weights.push_back(static_cast<float>(sample / sum));
  return weights;
}

bool convolve_gaussian(float* image, const std::array<int64_t, 3>& dims,
                       const std::array<double, 3>& sigma, const Executor& executor,
                       float* blurred) {
  const AxisKernel x(sigma[0], dims[0]), y(sigma[1], dims[1]), z(sigma[2], dims[2]);
  const auto plane_size = static_cast<size_t>(dims[0] * dims[1]);
  const auto planes = static_cast<size_t>(dims[2]);
  const bool planes_done = run_guarded(executor, planes, [&](size_t k) {
    convolve_plane(x, y, executor.simd(), image + k * plane_size);
  });
  const size_t tasks = (plane_size + kColumnValues - 1) / kColumnValues;
  return planes_done && run_guarded(executor, tasks, [&](size_t task) {
           const size_t begin = task * kColumnValues;
           const size_t end = std::min(begin + kColumnValues, plane_size);
           std::vector<const float*> rows;
           for (size_t k = 0; k < planes; ++k) {
             rows_of(z, k, image, plane_size, rows);
             kernels::weighted_rows(executor.simd(), z.weights.data(), z.weights.size(),
                                    rows.data(), begin, end, blurred + k * plane_size);
           }
         });
}

}  // namespace plc
