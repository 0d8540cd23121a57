#include "engine/measure/curvature.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>

#include "tests/samples/sample_implicit.h"
#include "tests/samples/sample_shapes.h"

namespace {

using samples::kPi;
using samples::Soup;

struct Curvatures {
  std::vector<double> mean, gaussian, area;
};

Curvatures curvatures(const Soup& m, const plc::Executor& executor = plc::SerialExecutor()) {
  const size_t n = m.vertex_count();
  Curvatures c{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  plc::vertex_curvature(m.arrays(), executor, c.mean.data(), c.gaussian.data(), c.area.data());
  return c;
}

using Truth = std::function<double(const double*)>;

struct Errors {
  std::vector<double> mean, gaussian;  // root mean squares over the area
  void add(const Soup& m, const Truth& mean_at, const Truth& gaussian_at) {
    const Curvatures c = curvatures(m);
    double total = 0, means = 0, gaussians = 0;
    for (size_t v = 0; v < c.mean.size(); ++v) {
      const double* p = m.xyz.data() + 3 * v;
      means += c.area[v] * std::pow(c.mean[v] - mean_at(p), 2);
      gaussians += c.area[v] * std::pow(c.gaussian[v] - gaussian_at(p), 2);
      total += c.area[v];
    }
    mean.push_back(std::sqrt(means / total));
    gaussian.push_back(std::sqrt(gaussians / total));
  }
};

// The sum of gaussian * area, and of the area against the faces'.
void check_gauss_bonnet(const Soup& m, double euler) {
  const Curvatures c = curvatures(m);
  double sum = 0, size = 0, area = 0;
  for (size_t v = 0; v < c.mean.size(); ++v) {
    sum += c.gaussian[v] * c.area[v];
    size += std::abs(c.gaussian[v] * c.area[v]);
    area += c.area[v];
  }
  CHECK(std::abs(sum - 2 * kPi * euler) < 1e-13 * (size + 1));
  double faces = 0;
  for (size_t i = 0; i < m.abc.size(); i += 3) {
    double u[3], v[3];
    for (size_t k = 0; k < 3; ++k) {
      u[k] = m.xyz[3 * m.abc[i + 1] + k] - m.xyz[3 * m.abc[i] + k];
      v[k] = m.xyz[3 * m.abc[i + 2] + k] - m.xyz[3 * m.abc[i] + k];
    }
    faces +=
        std::sqrt(std::pow(u[1] * v[2] - u[2] * v[1], 2) + std::pow(u[2] * v[0] - u[0] * v[2], 2) +
                  std::pow(u[0] * v[1] - u[1] * v[0], 2)) /
        2;
  }
  CHECK(area == Approx(faces).epsilon(1e-12));
}

}  // namespace

TEST_CASE("a sphere's curvatures converge to 1/r and 1/r^2 with order two", "[curvature]") {
  std::vector<double> sizes;
  Errors errors;
  const double r = 2.5;
  for (int level = 2; level < 6; ++level) {
    const Soup m = samples::moved(samples::sphere(level), 7, 0, -3, r);
    errors.add(
        m, [&](const double*) { return 1 / r; }, [&](const double*) { return 1 / (r * r); });
    sizes.push_back(std::pow(2, -level));
  }
  CHECK(samples::order_of(sizes, errors.mean) > 1.8);
  CHECK(samples::order_of(sizes, errors.gaussian) == Approx(2).margin(0.2));
  CHECK(errors.mean.back() < 1e-3);
}

TEST_CASE("a torus's curvatures converge to the closed forms with order two", "[curvature]") {
  std::vector<double> sizes;
  Errors errors;
  const double major = 2, minor = 0.6;
  // With the cosine of the angle around the tube: (R + 2 r cos) / (2 r (R + r cos)), and
  // cos / (r (R + r cos)).
  const auto ring = [&](const double* p) { return std::hypot(p[0], p[1]); };
  for (const uint32_t n : {12U, 24U, 48U, 96U}) {
    errors.add(
        samples::torus(2 * n, n, major, minor),
        [&](const double* p) { return (2 * ring(p) - major) / (2 * minor * ring(p)); },
        [&](const double* p) { return (ring(p) - major) / (minor * minor * ring(p)); });
    sizes.push_back(1.0 / n);
  }
  CHECK(samples::order_of(sizes, errors.mean) == Approx(2).margin(0.2));
  CHECK(samples::order_of(sizes, errors.gaussian) == Approx(2).margin(0.2));
  CHECK(errors.gaussian.back() < 0.01);
}

TEST_CASE("a surface turned inside out has the opposite mean curvature", "[curvature]") {
  const Soup m = samples::torus(24, 16, 2, 0.6);
  const Curvatures a = curvatures(m), b = curvatures(samples::flipped(m));
  for (size_t v = 0; v < a.mean.size(); ++v) {
    CHECK(b.mean[v] == Approx(-a.mean[v]).epsilon(1e-10));
    CHECK(b.gaussian[v] == Approx(a.gaussian[v]).epsilon(1e-10));
  }
}

TEST_CASE("the Gaussian curvatures of a closed surface sum to 2 pi times Euler's number",
          "[curvature]") {
  check_gauss_bonnet(samples::cube(), 2);
  check_gauss_bonnet(samples::sphere(4), 2);
  check_gauss_bonnet(samples::ellipsoid(4, 5, 1, 0.1), 2);  // obtuse faces
  check_gauss_bonnet(samples::torus(60, 30, 2, 0.6), 0);
  check_gauss_bonnet(samples::double_torus(1.0 / 23), -2);
  Soup rough = samples::sphere(4);
  std::mt19937 bits(11);
  std::normal_distribution<double> normal(0, 0.05);
  for (double& x : rough.xyz) x += normal(bits);
  check_gauss_bonnet(rough, 2);
}

TEST_CASE("the corner of a cube has the defect of a right angle", "[curvature]") {
  const Curvatures c = curvatures(samples::cube());
  for (size_t v = 0; v < 8; ++v) CHECK(c.gaussian[v] * c.area[v] == Approx(kPi / 2).epsilon(1e-14));
}

TEST_CASE("a sheet is flat inside and has no curvature at its border", "[curvature]") {
  Soup m = samples::turned(samples::sheet(6, 0.2));
  m.vertex(0, 0, 0);  // of no face
  const Curvatures c = curvatures(m);
  for (uint32_t v = 0; v < 49; ++v) {
    const uint32_t i = v % 7, j = v / 7;
    if (i % 6 == 0 || j % 6 == 0) {
      CHECK(std::isnan(c.mean[v]));
      CHECK(std::isnan(c.gaussian[v]));
      CHECK(c.area[v] > 0);
    } else {
      CHECK(std::abs(c.mean[v]) < 1e-12);
      CHECK(std::abs(c.gaussian[v]) < 1e-12);
    }
  }
  CHECK(std::isnan(c.mean[49]));
  CHECK(c.area[49] == 0);
}

TEST_CASE("curvatures keep their digits far from the origin", "[curvature]") {
  const Soup far = samples::moved(samples::sphere(3), 1048576, 1048576, -1048576);
  const Curvatures a = curvatures(samples::sphere(3)), b = curvatures(far);
  for (size_t v = 0; v < a.mean.size(); ++v) {
    CHECK(b.mean[v] == Approx(a.mean[v]).margin(1e-7));
    CHECK(b.gaussian[v] == Approx(a.gaussian[v]).margin(1e-6));
  }
}

TEST_CASE("curvatures are the same bits for any order of tasks", "[curvature]") {
  const Soup m = samples::torus(150, 70, 2, 0.6);
  const Curvatures a = curvatures(m), b = curvatures(m, samples::ReverseExecutor());
  CHECK(a.mean == b.mean);
  CHECK(a.gaussian == b.gaussian);
  CHECK(a.area == b.area);
}
