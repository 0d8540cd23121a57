#include "engine/transform/strip.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "tests/samples/sample_volumes.h"

namespace {

using plc::Rung;
using plc::Vec3;

constexpr double kPi = 3.14159265358979323846;

// Corners of a polygon at random angles in order, `backwards` turning the other way.
plc::Vector<Vec3> polygon(samples::Random& random, uint32_t count, double z, bool backwards) {
  std::vector<double> angles;
  for (uint32_t i = 0; i < count; ++i) angles.push_back(random.uniform(0, 2 * kPi));
  std::sort(angles.begin(), angles.end());
  if (backwards) std::reverse(angles.begin(), angles.end());
  const auto start = random.integer(0, count - 1);
  std::rotate(angles.begin(), angles.begin() + start, angles.end());
  plc::Vector<Vec3> corners;
  for (const double a : angles) {
    const double r = random.uniform(0.7, 1.3);
    corners.push_back({static_cast<float>(r * std::cos(a)), static_cast<float>(r * std::sin(a)),
                       static_cast<float>(z + random.uniform(-0.1, 0.1))});
  }
  return corners;
}

plc::Vector<Vec3> anywhere(samples::Random& random, uint32_t count) {
  plc::Vector<Vec3> points;
  for (uint32_t i = 0; i < count; ++i) {
    points.push_back({static_cast<float>(random.uniform(-1, 1)),
                      static_cast<float>(random.uniform(-1, 1)),
                      static_cast<float>(random.uniform(-1, 1))});
  }
  return points;
}

// Empty where the rungs are a strip: as many as corners, each a different edge, each step moves one
// corner on, p forwards or q backwards, and every corner has a rung.
std::string broken_strip(const plc::Vector<Rung>& rungs, uint32_t d, uint32_t e) {
  if (rungs.size() != d + e) return std::to_string(rungs.size()) + " rungs";
  std::set<std::pair<uint32_t, uint32_t>> edges;
  std::vector<bool> p(d), q(e);
  uint32_t forwards = 0;
  for (size_t k = 0; k < rungs.size(); ++k) {
    const Rung& r = rungs[k];
    const Rung& n = rungs[(k + 1) % rungs.size()];
    if (r.i >= d || r.j >= e) return "a corner that is none";
    if (!edges.insert({r.i, r.j}).second) return "an edge twice";
    const bool i_grows = n.i == (r.i + 1) % d && n.j == r.j;
    const bool j_falls = n.j == (r.j + e - 1) % e && n.i == r.i;
    if (i_grows == j_falls) return "a step that is none";
    forwards += i_grows ? 1 : 0;
    p[r.i] = q[r.j] = true;
  }
  if (forwards != d) return "more or less than once around";
  if (std::count(p.begin(), p.end(), false) + std::count(q.begin(), q.end(), false) != 0) {
    return "a corner without a rung";
  }
  return {};
}

double total(const plc::Vector<Rung>& rungs, const plc::Vector<Vec3>& p,
             const plc::Vector<Vec3>& q) {
  double sum = 0;
  for (const Rung& r : rungs) sum += static_cast<double>(plc::length(p[r.i] - q[r.j]));
  return sum;
}

// The least sum over every strip there is.
double least(const plc::Vector<Vec3>& p, const plc::Vector<Vec3>& q) {
  const auto d = static_cast<uint32_t>(p.size()), e = static_cast<uint32_t>(q.size());
  double best = std::numeric_limits<double>::infinity();
  // Steps as bits, 1: i grows. The last step of a strip from its first rung at p[0] is one of i.
  for (uint32_t steps = 0; steps < 1U << (d + e); ++steps) {
    if ((steps >> (d + e - 1) & 1) == 0) continue;
    if (static_cast<uint32_t>(__builtin_popcount(steps)) != d) continue;
    for (uint32_t start = 0; start < e; ++start) {
      plc::Vector<Rung> rungs{{0, start}};
      for (uint32_t k = 0; k + 1 < d + e; ++k) {
        Rung r = rungs.back();
        if ((steps >> k & 1) != 0) {
          r.i = (r.i + 1) % d;
        } else {
          r.j = (r.j + e - 1) % e;
        }
        rungs.push_back(r);
      }
      if (broken_strip(rungs, d, e).empty()) best = std::min(best, total(rungs, p, q));
    }
  }
  return best;
}

}  // namespace

TEST_CASE("strips of facing polygons of any sizes use every edge once", "[strip]") {
  samples::Random random(9);
  for (uint32_t d = 3; d <= 12; ++d) {
    for (uint32_t e = 3; e <= 12; ++e) {
      for (int repeat = 0; repeat < 40; ++repeat) {
        const auto p = polygon(random, d, 0, false);
        const auto q = polygon(random, e, 0.5, true);
        CHECK(broken_strip(plc::shortest_strip(p, q), d, e) == "");
      }
    }
  }
}

TEST_CASE("strips of polygons that turn alike, cross or lie anywhere use every edge once",
          "[strip]") {
  samples::Random random(10);
  for (uint32_t d = 3; d <= 9; ++d) {
    for (uint32_t e = 3; e <= 9; ++e) {
      for (int repeat = 0; repeat < 40; ++repeat) {
        const auto p = polygon(random, d, 0, false);
        CHECK(broken_strip(plc::shortest_strip(p, polygon(random, e, 0, false)), d, e) == "");
        CHECK(broken_strip(plc::shortest_strip(anywhere(random, d), anywhere(random, e)), d, e) ==
              "");
      }
    }
  }
}

TEST_CASE("one corner that is nearest to all does not take an edge twice", "[strip]") {
  // The shortest way would run to and from that corner and use its first edge again.
  for (uint32_t d = 3; d <= 9; ++d) {
    for (uint32_t e = 3; e <= 9; ++e) {
      for (uint32_t hub = 0; hub < d + e; ++hub) {
        plc::Vector<Vec3> p, q;
        for (uint32_t i = 0; i < d; ++i) p.push_back({100 + static_cast<float>(i), 0, 0});
        for (uint32_t j = 0; j < e; ++j) q.push_back({-100 - static_cast<float>(j), 0, 0});
        (hub < d ? p[hub] : q[hub - d]) = {hub < d ? -100.0F : 100.0F, 0.5F, 0};
        CHECK(broken_strip(plc::shortest_strip(p, q), d, e) == "");
        // Two hubs that want all: one of each polygon.
        q[hub % e] = {100, 1, 0};
        p[hub % d] = {-100, 1, 0};
        CHECK(broken_strip(plc::shortest_strip(p, q), d, e) == "");
      }
    }
  }
}

TEST_CASE("polygons that have shrunk to points or coincide have a strip", "[strip]") {
  for (uint32_t d = 3; d <= 9; ++d) {
    for (uint32_t e = 3; e <= 9; ++e) {
      const plc::Vector<Vec3> p(d, Vec3{1, 2, 3});
      CHECK(broken_strip(plc::shortest_strip(p, plc::Vector<Vec3>(e, Vec3{1, 2, 3})), d, e) == "");
      CHECK(broken_strip(plc::shortest_strip(p, plc::Vector<Vec3>(e, Vec3{4, 2, 3})), d, e) == "");
      samples::Random random(d * 10 + e);
      const auto q = polygon(random, e, 0, true);
      CHECK(broken_strip(plc::shortest_strip(p, q), d, e) == "");
      CHECK(broken_strip(plc::shortest_strip(q, p), e, d) == "");
    }
  }
}

TEST_CASE("the strip between facing polygons is the shortest there is", "[strip]") {
  samples::Random random(11);
  for (uint32_t d = 3; d <= 6; ++d) {
    for (uint32_t e = 3; e <= 6; ++e) {
      for (int repeat = 0; repeat < 6; ++repeat) {
        const auto p = polygon(random, d, 0, false);
        const auto q = polygon(random, e, 0.5, true);
        CAPTURE(d, e, repeat);
        CHECK(total(plc::shortest_strip(p, q), p, q) == Approx(least(p, q)));
      }
    }
  }
}

TEST_CASE("regular polygons that face each other are joined straight across", "[strip]") {
  for (uint32_t n = 3; n <= 9; ++n) {
    plc::Vector<Vec3> p, q;
    for (uint32_t i = 0; i < n; ++i) {
      const double a = 2 * kPi * i / n;
      p.push_back({static_cast<float>(std::cos(a)), static_cast<float>(std::sin(a)), 0});
      q.push_back({static_cast<float>(std::cos(-a)), static_cast<float>(std::sin(-a)), 0.3F});
    }
    int straight = 0;
    for (const Rung& r : plc::shortest_strip(p, q)) straight += (r.i + r.j) % n == 0 ? 1 : 0;
    CHECK(straight == static_cast<int>(n));
  }
}

TEST_CASE("strips of long rings use every edge once", "[strip]") {
  samples::Random random(12);
  for (const uint32_t d : {3U, 20U, 43U}) {
    for (const uint32_t e : {3U, 31U}) {
      const auto p = polygon(random, d, 0, false);
      const auto q = polygon(random, e, 0.5, true);
      CHECK(broken_strip(plc::shortest_strip(p, q), d, e) == "");
    }
  }
}
