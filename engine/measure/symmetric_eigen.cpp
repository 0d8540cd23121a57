#include "engine/measure/symmetric_eigen.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace plc {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

constexpr int kMaxSweeps = 32;  // convergence is quadratic: 4 to 6 are taken

// The rotation in the plane of axes p and q that makes a[p][q] zero.
void rotate(Matrix& a, Matrix& frame, size_t p, size_t q) {
  if (a[p][q] == 0) return;
  const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
  const double c = 1 / std::sqrt(t * t + 1), s = t * c;
  const size_t r = 3 - p - q;
  const double pq = a[p][q], rp = a[r][p], rq = a[r][q];
  a[p][p] -= t * pq;
  a[q][q] += t * pq;
  a[p][q] = a[q][p] = 0;
  a[r][p] = a[p][r] = c * rp - s * rq;
  a[r][q] = a[q][r] = s * rp + c * rq;
  for (size_t k = 0; k < 3; ++k) {
    const double fp = frame[p][k], fq = frame[q][k];
    frame[p][k] = c * fp - s * fq;
    frame[q][k] = s * fp + c * fq;
  }
}

void make_positive(std::array<double, 3>& axis) {
  size_t largest = 0;
  for (size_t k = 1; k < 3; ++k) {
    if (std::abs(axis[k]) > std::abs(axis[largest])) largest = k;
  }
  if (axis[largest] >= 0) return;
  for (double& x : axis) x = -x;
}

}  // namespace

SymmetricEigen symmetric_eigen(const SymmetricMatrix& m) {
  SymmetricEigen result{};
  double scale = 0;
  bool finite = true;
  for (const double x : m) {
    finite = finite && std::isfinite(x);
    scale = std::max(scale, std::abs(x));
  }
  if (!finite) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    result.value.fill(kNan);
    for (auto& axis : result.axis) axis.fill(kNan);
    return result;
  }
  if (scale == 0) scale = 1;
  Matrix a = {{{m[0], m[3], m[5]}, {m[3], m[1], m[4]}, {m[5], m[4], m[2]}}};
  for (auto& row : a) {
    for (double& x : row) x /= scale;  // no square over- or underflows
  }
  Matrix frame = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  // What is off the diagonal and below this changes no eigenvalue by a rounding.
  constexpr double kNothing = 1e-40;
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    if (a[0][1] * a[0][1] + a[1][2] * a[1][2] + a[0][2] * a[0][2] < kNothing) break;
    rotate(a, frame, 0, 1);
    rotate(a, frame, 0, 2);
    rotate(a, frame, 1, 2);
  }
  std::array<size_t, 3> order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t i, size_t j) { return a[i][i] > a[j][j]; });
  for (size_t i = 0; i < 3; ++i) {
    result.value[i] = a[order[i]][order[i]] * scale;
    result.axis[i] = frame[order[i]];
  }
  make_positive(result.axis[0]);
  make_positive(result.axis[1]);
  const auto &u = result.axis[0], &v = result.axis[1];
  result.axis[2] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                    u[0] * v[1] - u[1] * v[0]};
  return result;
}

}  // namespace plc
