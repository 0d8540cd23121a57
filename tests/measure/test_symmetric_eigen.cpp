#include "engine/measure/symmetric_eigen.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

namespace {

using plc::SymmetricEigen;
using plc::SymmetricMatrix;

std::array<double, 3> times(const SymmetricMatrix& m, const std::array<double, 3>& x) {
  return {m[0] * x[0] + m[3] * x[1] + m[5] * x[2], m[3] * x[0] + m[1] * x[1] + m[4] * x[2],
          m[5] * x[0] + m[4] * x[1] + m[2] * x[2]};
}

double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void check_frame(const SymmetricMatrix& m) {
  const SymmetricEigen e = plc::symmetric_eigen(m);
  double scale = 0;
  for (const double x : m) scale = std::max(scale, std::abs(x));
  for (size_t i = 0; i < 3; ++i) {
    const std::array<double, 3> image = times(m, e.axis[i]);
    for (size_t k = 0; k < 3; ++k) {
      CHECK(std::abs(image[k] - e.value[i] * e.axis[i][k]) <= 4e-15 * scale);
    }
    for (size_t j = 0; j < 3; ++j) {
      CHECK(std::abs(dot(e.axis[i], e.axis[j]) - (i == j ? 1 : 0)) <= 4e-15);
    }
  }
  CHECK(e.value[0] >= e.value[1]);
  CHECK(e.value[1] >= e.value[2]);
  const auto &u = e.axis[0], &v = e.axis[1], &w = e.axis[2];
  CHECK(u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
            u[2] * (v[0] * w[1] - v[1] * w[0]) ==
        Approx(1));
}

}  // namespace

TEST_CASE("axes are unit, at right angles, right-handed and eigenvectors", "[symmetric_eigen]") {
  std::mt19937 bits(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 200; ++trial) {
    SymmetricMatrix m{};
    for (double& x : m) x = normal(bits);
    if (trial % 4 == 1) m[0] *= 1e9;
    if (trial % 4 == 2) m[3] *= 1e-9;
    if (trial % 4 == 3) m = {m[0], m[0], m[0], m[3], m[3], m[3]};  // two equal values
    check_frame(m);
  }
}

TEST_CASE("the eigenvalues of a matrix with known ones are those", "[symmetric_eigen]") {
  const SymmetricEigen e = plc::symmetric_eigen({2, 2, 5, 1, 0, 0});
  CHECK(e.value[0] == 5);
  CHECK(e.value[1] == Approx(3).epsilon(1e-15));
  CHECK(e.value[2] == Approx(1).epsilon(1e-15));
  CHECK(e.axis[0] == std::array<double, 3>{0, 0, 1});
  CHECK(e.axis[1][0] == Approx(std::sqrt(0.5)));
  CHECK(e.axis[1][1] == Approx(std::sqrt(0.5)));
}

TEST_CASE("a diagonal matrix keeps its values, any size of them", "[symmetric_eigen]") {
  for (const double scale : {1.0, 1e-200, 1e200}) {
    const SymmetricEigen e = plc::symmetric_eigen({scale, 3 * scale, 2 * scale, 0, 0, 0});
    CHECK(e.value == std::array<double, 3>{3 * scale, 2 * scale, scale});
    CHECK(e.axis[0] == std::array<double, 3>{0, 1, 0});
    CHECK(e.axis[1] == std::array<double, 3>{0, 0, 1});
    CHECK(e.axis[2] == std::array<double, 3>{1, 0, 0});
    check_frame({scale, 3 * scale, 2 * scale, scale / 2, -scale, scale / 7});
  }
  const SymmetricEigen zero = plc::symmetric_eigen({});
  CHECK(zero.value == std::array<double, 3>{0, 0, 0});
  CHECK(zero.axis[2] == std::array<double, 3>{0, 0, 1});
}

TEST_CASE("a matrix that is not finite has no values", "[symmetric_eigen]") {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const SymmetricEigen e = plc::symmetric_eigen({1, 2, 3, bad, 0, 0});
    CHECK(std::isnan(e.value[0]));
    CHECK(std::isnan(e.axis[2][2]));
  }
}
