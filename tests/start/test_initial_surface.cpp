#include "engine/start/initial_surface.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/constants.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_woken.h"

namespace {

using plc::Extent;
using plc::Mesh;

struct Edges {
  double shortest = 1e30, mean = 0, longest = 0;
};

// In units of delta.
Edges edges_of(const Mesh& mesh) {
  Edges e;
  int64_t count = 0;
  samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
    const double l =
        static_cast<double>(plc::length(mesh.at(u) - mesh.at(mesh.neighbor(u, k)))) / mesh.delta;
    e.shortest = std::min(e.shortest, l);
    e.longest = std::max(e.longest, l);
    e.mean += l;
    ++count;
  });
  e.mean /= static_cast<double>(count);
  return e;
}

}  // namespace

TEST_CASE("a bubble is one closed sphere through the corners of the box", "[initial_surface]") {
  for (const Extent& box : {Extent{{-5, -5, -5}, {5, 5, 5}}, Extent{{0, 10, -3}, {20, 24, 9}},
                            Extent{{-30, -4, 100}, {30, 4, 110}}}) {
    for (const double delta : {0.5, 0.83, 2.0}) {
      Mesh mesh;
      const samples::Woken woken(mesh);
      REQUIRE(plc::make_bubble(mesh, box, delta, samples::kSerial).ok());
      REQUIRE(plc::broken_invariant(mesh) == "");
      CHECK(mesh.delta == delta);
      CHECK(samples::euler(mesh) == 2);
      CHECK(samples::component_count(mesh) == 1);
      CHECK(samples::meeting_count(mesh) == 0);
      double box_volume = 1;
      for (size_t a = 0; a < 3; ++a) box_volume *= box.high[a] - box.low[a];
      CHECK(samples::volume(mesh) > box_volume);
      CHECK(samples::volume(mesh) < 3.5 * box_volume);
      // |x/a|^4 + |y/b|^4 + |z/c|^4 = 3 with the box's half extents.
      for (uint32_t v = 0; v < mesh.slots(); ++v) {
        const std::array<double, 3> p{mesh.at(v).x, mesh.at(v).y, mesh.at(v).z};
        double sum = 0;
        for (size_t a = 0; a < 3; ++a) {
          const double half = (box.high[a] - box.low[a]) / 2;
          sum += std::pow((p[a] - (box.high[a] + box.low[a]) / 2) / half, 4);
        }
        CHECK(sum == Approx(3).epsilon(1e-3));
        CHECK(woken[v]);
      }
    }
  }
}

TEST_CASE("a bubble's edges fit delta", "[initial_surface]") {
  for (double delta = 0.3; delta < 3; delta *= 1.1) {
    Mesh mesh;
    REQUIRE(plc::make_bubble(mesh, {{-8, -8, -8}, {8, 8, 8}}, delta, samples::kSerial).ok());
    const Edges e = edges_of(mesh);
    CAPTURE(delta, e.shortest, e.longest);
    CHECK(e.mean > 1);
    CHECK(e.mean < 2.7);
    CHECK(e.longest < 3.46);  // what the embedding guard allows for
  }
}

TEST_CASE("a flat or tiny box gets a bubble with room inside", "[initial_surface]") {
  for (const Extent& box : {Extent{{0, 0, 0}, {20, 20, 0}}, Extent{{3, 3, 3}, {3, 3, 3}},
                            Extent{{0, 0, 0}, {0, 0, 15}}}) {
    Mesh mesh;
    REQUIRE(plc::make_bubble(mesh, box, 1, samples::kSerial).ok());
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(samples::meeting_count(mesh) == 0);
    CHECK(samples::volume(mesh) > 8);
  }
}

TEST_CASE("a bubble replaces what was in the mesh", "[initial_surface]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::torus(20, 10, 3, 1), 1);
  mesh.destroy(4);
  REQUIRE(plc::make_bubble(mesh, {{0, 0, 0}, {9, 9, 9}}, 1, samples::kSerial).ok());
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(samples::euler(mesh) == 2);
  CHECK(mesh.slots() == mesh.vertex_count());
}

TEST_CASE("bubbles fill the box side by side, apart by (3)", "[initial_surface]") {
  for (const std::array<int, 3>& counts :
       {std::array{1, 1, 1}, std::array{2, 3, 4}, std::array{5, 1, 1}}) {
    const Extent box{{-10, 0, 5}, {14, 25, 35}};
    Mesh mesh;
    REQUIRE(plc::make_bubbles(mesh, box, counts, 1, samples::kSerial).ok());
    REQUIRE(plc::broken_invariant(mesh) == "");
    const int64_t count = int64_t{counts[0]} * counts[1] * counts[2];
    CHECK(samples::component_count(mesh) == count);
    CHECK(samples::euler(mesh) == 2 * count);
    CHECK(samples::meeting_count(mesh) == 0);
    CHECK(samples::volume(mesh) > 0);
    CHECK(edges_of(mesh).longest < 2.5);
    const uint32_t each = mesh.slots() / static_cast<uint32_t>(count);
    float nearest = 1e30F;
    for (uint32_t u = 0; u < mesh.slots(); ++u) {
      const plc::Vec3 p = mesh.at(u);
      CHECK((p.x >= -10 && p.x <= 14 && p.y >= 0 && p.y <= 25 && p.z >= 5 && p.z <= 35));
      for (uint32_t v = u + 1; v < mesh.slots(); ++v) {
        if (u / each != v / each) nearest = std::min(nearest, plc::length(p - mesh.at(v)));
      }
    }
    CHECK(nearest >= plc::kMinApart);
  }
}

TEST_CASE("bubbles that would be too small for delta are refused with their numbers",
          "[initial_surface]") {
  Mesh mesh;
  const Extent box{{0, 0, 0}, {20, 20, 20}};
  CHECK(plc::make_bubbles(mesh, box, {5, 5, 5}, 1, samples::kSerial).ok());
  const plc::Status status = plc::make_bubbles(mesh, box, {5, 6, 5}, 1, samples::kSerial);
  CHECK(status.code() == plc::ErrorCode::kInvalidArgument);
  CHECK_THAT(status.message(), Catch::Matchers::Contains("bubbles 5 x 6 x 5") &&
                                   Catch::Matchers::Contains("too small"));
}

TEST_CASE("a start of more vertices than a mesh can have is refused before it takes memory",
          "[initial_surface]") {
  Mesh mesh;
  const plc::Extent box{{0, 0, 0}, {100, 100, 100}};
  CHECK(plc::make_bubble(mesh, box, 1e-4, samples::kSerial).code() == plc::ErrorCode::kOutOfMemory);
  CHECK(plc::make_bubbles(mesh, box, {256, 256, 256}, 1e-3, samples::kSerial).code() ==
        plc::ErrorCode::kOutOfMemory);
  mesh.delta = 1;
  for (const float radius : {1e7F, HUGE_VALF}) {
    CHECK(plc::append_bubble(mesh, {0, 0, 0}, {radius, radius, radius}, samples::kSerial).code() ==
          plc::ErrorCode::kOutOfMemory);
  }
  CHECK(mesh.slots() == 0);
}
