#include "engine/measure/moments.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/samples/sample_implicit.h"
#include "tests/samples/sample_shapes.h"

namespace {

using plc::ShapeMeasures;
using samples::kPi;
using samples::Soup;

ShapeMeasures shape(const Soup& m, const plc::Executor& executor = plc::SerialExecutor()) {
  return plc::shape_measures(m.arrays(), executor);
}

const double kOffset[3] = {0.3, -0.2, 0.7};

// Errors of area, volume, centroid, moments (against the given diagonal) at each refinement.
struct Errors {
  std::vector<double> area, volume, centroid, moments;
  void add(const plc::ComponentShape& c, double true_area, double true_volume,
           const double (&diagonal)[3]) {
    area.push_back(std::abs(c.area / true_area - 1));
    volume.push_back(std::abs(c.volume / true_volume - 1));
    double off = 0, worst = 0;
    for (int k = 0; k < 3; ++k) {
      off = std::max(off, std::abs(c.centroid[k] - kOffset[k]));
      worst = std::max(worst, std::abs(c.moments[k] / diagonal[k] - 1));
      CHECK(std::abs(c.moments[k + 3]) < 1e-12 * diagonal[0]);
    }
    centroid.push_back(off);
    moments.push_back(worst);
  }
  void check_second_order(const std::vector<double>& sizes) const {
    CHECK(samples::order_of(sizes, area) == Approx(2).margin(0.1));
    CHECK(samples::order_of(sizes, volume) == Approx(2).margin(0.1));
    CHECK(samples::order_of(sizes, moments) == Approx(2).margin(0.1));
    for (const double off : centroid) CHECK(off < 1e-12);  // by symmetry
  }
};

Soup placed(const Soup& m) {
  return samples::moved(m, kOffset[0], kOffset[1], kOffset[2]);
}

// Area of an ellipsoid with half-axes a > b = c: 2 pi (b^2 + a b asin(e) / e).
double prolate_area(double a, double b) {
  const double e = std::sqrt(1 - b * b / (a * a));
  return 2 * kPi * (b * b + a * b * std::asin(e) / e);
}

}  // namespace

TEST_CASE("a ball's second moments converge to V r^2 / 5 with order two", "[moments]") {
  std::vector<double> sizes;
  Errors errors;
  for (int level = 2; level < 6; ++level) {
    const double r = 1.5, volume = 4 * kPi / 3 * r * r * r, moment = volume * r * r / 5;
    const ShapeMeasures s = shape(placed(samples::moved(samples::sphere(level), 0, 0, 0, r)));
    sizes.push_back(std::pow(2, -level));
    errors.add(s.whole, 4 * kPi * r * r, volume, {moment, moment, moment});
    CHECK(s.whole.euler == 2);
    CHECK(s.whole.genus == 0);
    for (int k = 0; k < 3; ++k) {
      CHECK(s.whole.low[k] == kOffset[k] - r);
      CHECK(s.whole.high[k] == kOffset[k] + r);
    }
  }
  errors.check_second_order(sizes);
  CHECK(errors.moments.back() < 0.005);
}

TEST_CASE("an ellipsoid's moments converge to V a^2 / 5 with order two", "[moments]") {
  std::vector<double> sizes;
  Errors errors;
  for (int level = 2; level < 6; ++level) {
    const double a = 2, b = 0.8, volume = 4 * kPi / 3 * a * b * b;
    const ShapeMeasures s = shape(placed(samples::ellipsoid(level, a, b, b)));
    sizes.push_back(std::pow(2, -level));
    errors.add(s.whole, prolate_area(a, b), volume,
               {volume * a * a / 5, volume * b * b / 5, volume * b * b / 5});
  }
  errors.check_second_order(sizes);
}

TEST_CASE("a torus's moments converge to the closed forms with order two", "[moments]") {
  std::vector<double> sizes;
  Errors errors;
  const double major = 2, minor = 0.6, volume = 2 * kPi * kPi * major * minor * minor;
  // Of the solid torus: V (4 R^2 + 3 r^2) / 8 across the axis, V r^2 / 4 along it.
  const double across = volume * (4 * major * major + 3 * minor * minor) / 8;
  for (const uint32_t n : {12U, 24U, 48U, 96U}) {
    const ShapeMeasures s = shape(placed(samples::torus(2 * n, n, major, minor)));
    sizes.push_back(1.0 / n);
    errors.add(s.whole, 4 * kPi * kPi * major * minor, volume,
               {across, across, volume * minor * minor / 4});
    CHECK(s.whole.euler == 0);
    CHECK(s.whole.genus == 1);
  }
  errors.check_second_order(sizes);
}

TEST_CASE("a double torus has genus 2 and converges to its volume with order two", "[moments]") {
  const double volume = samples::double_torus_volume();
  std::vector<double> sizes, errors, areas;
  for (const double size : {1.0 / 17, 1.0 / 34, 1.0 / 68}) {
    const ShapeMeasures s = shape(samples::double_torus(size));
    REQUIRE(s.components.size() == 1);
    CHECK(s.whole.genus == 2);
    CHECK(s.whole.euler == -2);
    sizes.push_back(size);
    errors.push_back(std::abs(s.whole.volume - volume));
    areas.push_back(s.whole.area);
    for (int k = 0; k < 3; ++k) CHECK(std::abs(s.whole.centroid[k]) < size * size / 10);
    CHECK(s.whole.principal_axes[0] == Approx(1).epsilon(1e-3));  // the long side
  }
  CHECK(samples::order_of(sizes, errors) == Approx(2).margin(0.25));
  CHECK(areas[2] - areas[1] < (areas[1] - areas[0]) / 2.5);
}

TEST_CASE("a box has its moments exactly, and its axes are those it was turned to", "[moments]") {
  Soup box = samples::cube();
  for (size_t i = 0; i < box.xyz.size(); i += 3) {
    box.xyz[i] *= 2;
    box.xyz[i + 1] *= 5;
    box.xyz[i + 2] *= 3;
  }
  const plc::ComponentShape plain = shape(box).whole;
  CHECK(plain.volume == Approx(30).epsilon(1e-14));
  CHECK(plain.moments[0] == Approx(30 * 4.0 / 12).epsilon(1e-14));
  CHECK(plain.moments[1] == Approx(30 * 25.0 / 12).epsilon(1e-14));
  CHECK(plain.moments[2] == Approx(30 * 9.0 / 12).epsilon(1e-14));
  CHECK(plain.centroid[1] == Approx(2.5).epsilon(1e-14));
  const plc::ComponentShape turned = shape(samples::turned(box)).whole;
  const auto r = samples::turn();
  const size_t column[3] = {1, 2, 0};  // 5, 3, 2
  for (size_t i = 0; i < 3; ++i) {
    CHECK(turned.principal_moments[i] == Approx(plain.moments[column[i]]).epsilon(1e-13));
    double along = 0;
    for (size_t k = 0; k < 3; ++k) along += turned.principal_axes[3 * i + k] * r[k][column[i]];
    CHECK(std::abs(along) == Approx(1).epsilon(1e-13));
  }
}

TEST_CASE("moments far from the origin lose no digits", "[moments]") {
  const Soup near = samples::turned(samples::ellipsoid(3, 1, 0.75, 0.5));
  Soup far = near;
  for (size_t i = 0; i < far.xyz.size(); ++i) far.xyz[i] += i % 3 == 0 ? 1048576 : -524288;
  Soup back = far;  // rounded as the far one is
  for (size_t i = 0; i < far.xyz.size(); ++i) back.xyz[i] -= i % 3 == 0 ? 1048576 : -524288;
  const plc::ComponentShape a = shape(back).whole, b = shape(far).whole;
  for (int k = 0; k < 6; ++k) CHECK(b.moments[k] == a.moments[k]);
  CHECK(b.centroid[0] == Approx(a.centroid[0] + 1048576).epsilon(1e-15));
}

TEST_CASE("the whole of a shell and its cavity is the difference of two balls", "[moments]") {
  Soup m = samples::flipped(samples::moved(samples::sphere(4), 0.2, 0, 0, 0.5));
  m.append(samples::sphere(4));
  const ShapeMeasures s = shape(m);
  REQUIRE(s.components.size() == 2);
  const plc::ComponentShape &outer = s.components[0], &inner = s.components[1];
  CHECK(outer.first_face == 2048);
  CHECK(inner.first_face == 0);
  CHECK(inner.volume < 0);
  CHECK(inner.principal_moments[0] < 0);
  CHECK(inner.centroid[0] == Approx(0.2).epsilon(1e-12));
  CHECK(s.whole.volume == Approx(outer.volume * 7 / 8).epsilon(1e-12));
  // c = -0.2 / 8 / (7 / 8); about the origin the moments subtract.
  const double c = -0.2 / 7, moment = outer.moments[0];
  CHECK(s.whole.centroid[0] == Approx(c).epsilon(1e-12));
  CHECK(s.whole.moments[0] ==
        Approx(moment - moment / 32 - outer.volume / 8 * 0.04 - outer.volume * 7 / 8 * c * c)
            .epsilon(1e-12));
  CHECK(s.whole.moments[1] == Approx(moment * 31 / 32).epsilon(1e-12));
  CHECK(s.whole.area == outer.area + inner.area);
}

TEST_CASE("what encloses no volume has no centroid, but an area and a box", "[moments]") {
  Soup open = samples::sphere(2);
  open.abc.resize(open.abc.size() - 3);
  const plc::ComponentShape c = shape(open).whole;
  CHECK(std::isnan(c.volume));
  CHECK(std::isnan(c.centroid[0]));
  CHECK(std::isnan(c.moments[5]));
  CHECK(std::isnan(c.principal_axes[8]));
  CHECK(c.area > 11);
  CHECK(c.high[2] == 1);
  CHECK(c.genus == -1);
  const ShapeMeasures empty = shape(Soup());
  CHECK(empty.components.empty());
  CHECK(empty.whole.volume == 0);
  CHECK(std::isnan(empty.whole.centroid[0]));
}

TEST_CASE("two cubes that share an edge enclose the volume of both", "[moments]") {
  Soup m = samples::cube();
  const Soup other = samples::cube();  // its edge (0, 0, *) is edge (1, 1, *) of the first
  uint32_t id[8];
  for (uint32_t v = 0; v < 8; ++v) {
    const double* p = other.xyz.data() + 3 * v;
    id[v] = (v & 3U) == 0 ? v + 3 : m.vertex(p[0] + 1, p[1] + 1, p[2]);
  }
  for (size_t i = 0; i < other.abc.size(); i += 3) {
    m.face(id[other.abc[i]], id[other.abc[i + 1]], id[other.abc[i + 2]]);
  }
  const ShapeMeasures s = shape(m);
  REQUIRE(s.components.size() == 1);
  CHECK(s.whole.genus == -1);
  CHECK(s.whole.volume == Approx(2).epsilon(1e-14));
  CHECK(s.whole.centroid[0] == Approx(1).epsilon(1e-14));
}

TEST_CASE("shapes are the same bits for any order of tasks", "[moments]") {
  Soup m = samples::torus(300, 120, 2, 0.6);  // more than one chunk of faces
  m.append(samples::moved(samples::sphere(3), 5, 0, 0));
  const ShapeMeasures a = shape(m), b = shape(m, samples::ReverseExecutor());
  CHECK(samples::bytes_of(a.whole) == samples::bytes_of(b.whole));
  CHECK(samples::bytes_of(a.components[1]) == samples::bytes_of(b.components[1]));
}
