#include "engine/exact/vertex_star.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "engine/exact/triangle_intersection.h"
#include "tests/samples/sample_rings.h"

namespace {

using samples::Soup;
constexpr double kPi = 3.14159265358979323846;

// A fan around vertex 0 at the given place, closed.
Soup fan(const std::vector<std::array<double, 3>>& ring, double x = 0, double y = 0, double z = 0) {
  Soup m;
  m.vertex(x, y, z);
  for (const auto& p : ring) m.vertex(x + p[0], y + p[1], z + p[2]);
  const auto n = static_cast<uint32_t>(ring.size());
  for (uint32_t k = 0; k < n; ++k) m.face(0, 1 + k, 1 + (k + 1) % n);
  return m;
}

// Only the ring of vertex 0 closes.
samples::Rings rings_of_fan(const Soup& m) {
  const auto n = static_cast<uint32_t>(m.face_count());
  samples::Rings r;
  r.columns.assign(plc::kRingColumns * plc::kRingLanes, 0);
  r.valence.assign(plc::kRingLanes, 0);
  r.valence[0] = static_cast<uint16_t>(n);
  for (uint32_t k = 0; k < n; ++k) {
    if (k < plc::kRingSlots) r.columns[k * plc::kRingLanes] = 1 + k;
    if (k >= plc::kRingSlots) r.tail.push_back(1 + k);
  }
  for (size_t v = 0; v < m.vertex_count(); ++v) {
    r.positions.push_back({static_cast<float>(m.xyz[3 * v]), static_cast<float>(m.xyz[3 * v + 1]),
                           static_cast<float>(m.xyz[3 * v + 2]), 0});
  }
  return r;
}

bool plain(const Soup& m) {
  const samples::Rings r = rings_of_fan(m);
  return plc::star_is_embedded(r.view(), r.positions.data(), 0);
}

bool meets_itself(const Soup& m) {
  const samples::Rings r = rings_of_fan(m);
  for (size_t f = 0; f < m.face_count(); ++f) {
    for (size_t g = f + 1; g < m.face_count(); ++g) {
      if (plc::triangles_intersect(plc::make_triangle(r.positions.data(), m.abc.data() + 3 * f),
                                   plc::make_triangle(r.positions.data(), m.abc.data() + 3 * g))) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

TEST_CASE("every star of a smooth surface is plain", "[vertex_star]") {
  for (const Soup& m :
       {samples::sphere(3), samples::torus(30, 18, 2, 0.7), samples::octahedron()}) {
    const samples::Rings r = samples::rings_of(m);
    for (uint32_t v = 0; v < r.slots(); ++v) {
      CHECK(plc::star_is_embedded(r.view(), r.positions.data(), v));
    }
  }
}

TEST_CASE("a flat star along the axes is plain in every position and orientation",
          "[vertex_star]") {
  for (const double x : {0.0, 0.3, 1000.25}) {
    CHECK(plain(fan({{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, x, x, x)));
    CHECK(plain(fan({{0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}}, x, x, x)));
    CHECK(plain(fan({{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}}, x, x, x)));
    CHECK(plain(fan({{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}, x, x, x)));
  }
}

TEST_CASE("a star that goes around twice is not plain", "[vertex_star]") {
  std::vector<std::array<double, 3>> ring;
  for (int k = 0; k < 5; ++k) {
    const double angle = 4 * kPi * k / 5;
    ring.push_back({std::cos(angle), std::sin(angle), 0.2});
  }
  CHECK(meets_itself(fan(ring)));
  CHECK_FALSE(plain(fan(ring)));
  ring.clear();
  for (int k = 0; k < 12; ++k) {
    const double angle = 4 * kPi * k / 12;
    ring.push_back({std::cos(angle), std::sin(angle), 0.1 * k});
  }
  CHECK_FALSE(plain(fan(ring)));
}

TEST_CASE("a star with a folded or flat face is not plain", "[vertex_star]") {
  CHECK_FALSE(plain(fan({{1, 0, 0}, {0, 1, 0}, {0.5, 1, 0}, {-1, 0, 0}, {0, -1, 0}})));
  CHECK_FALSE(plain(fan({{1, 0, 0}, {0, 1, 0}, {0, 2, 0}, {-1, 0, 0}, {0, -1, 0}})));
  CHECK_FALSE(plain(fan({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}, {-1, 0, 0}, {0, -1, 0}})));
}

TEST_CASE("a plain star never meets itself", "[vertex_star]") {
  std::mt19937 bits(1);
  std::uniform_real_distribution<double> unit(-1, 1);
  int plain_ones = 0, crossing = 0;
  for (int i = 0; i < 20000; ++i) {
    const int n = 3 + i % 12;
    const double noise = (i % 7 + 1) * 0.12;
    const int turns = i % 5 == 0 ? 2 : 1;
    std::vector<std::array<double, 3>> ring;
    for (int k = 0; k < n; ++k) {
      const double angle = turns * 2 * kPi * k / n + noise * unit(bits), r = 0.6 + 0.4 * unit(bits);
      ring.push_back({r * std::cos(angle), r * std::sin(angle), 2 * noise * unit(bits)});
      if (i % 3 == 0) {  // a grid: exact zeros everywhere
        for (double& x : ring.back()) x = std::round(x * 3) / 4;
      }
      if (i % 2 == 0) std::swap(ring.back()[0], ring.back()[2]);
    }
    const Soup m = fan(ring, i % 4, 0.1, i % 9 * 10.0);
    const bool is_plain = plain(m), meets = meets_itself(m);
    REQUIRE_FALSE((is_plain && meets));
    plain_ones += is_plain ? 1 : 0;
    crossing += meets ? 1 : 0;
  }
  CHECK(plain_ones > 2000);
  CHECK(crossing > 2000);
}
