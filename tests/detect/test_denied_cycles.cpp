#include "engine/detect/denied_cycles.h"

#include <catch2/catch.hpp>
#include <set>

#include "tests/samples/sample_sizing.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Mesh;

// Of nine cross-sections; inside out it is a way through the object. Its edges are within (1) and
// (2).
struct Tube {
  Tube(uint32_t sides, bool inside_out, bool object) : image(object) {
    samples::Soup soup = samples::tube(sides, 9, 0.8);
    for (size_t f = 0; inside_out && f < soup.abc.size(); f += 3) {
      std::swap(soup.abc[f], soup.abc[f + 1]);
    }
    samples::fill_mesh(mesh, soup, 1);
    mesh.sizing = &image.sizing;
  }
  std::optional<plc::Candidate> denied(uint32_t u) const { return plc::denied_cycle(mesh, u); }

  samples::FullImage image;
  Mesh mesh;
};

std::set<uint32_t> corners_of(const plc::Candidate& candidate) {
  const plc::Cycle cycle = candidate.cycle();
  return {cycle.corner.begin(), cycle.corner.begin() + cycle.size};
}

}  // namespace

TEST_CASE("three edges around what the image does not have are denied", "[denied_cycles]") {
  for (const bool inside_out : {false, true}) {
    CHECK_FALSE(Tube(3, inside_out, !inside_out).denied(12).has_value());
    const Tube tube(3, inside_out, inside_out);
    // The middle cross-section.
    const auto candidate = tube.denied(12);
    REQUIRE(candidate.has_value());
    CHECK(candidate->operation == plc::Operation::kAnnular);
    CHECK(candidate->key == Approx(3 * 0.8 * 0.8));
    CHECK(corners_of(*candidate) == std::set<uint32_t>{12, 13, 14});
    // A tip of a few vertices.
    CHECK_FALSE(tube.denied(3).has_value());
  }
}

TEST_CASE("what the image has in the middle of an edge is not denied, a way through is",
          "[denied_cycles]") {
  // Of the middle cross-section the middle of an edge lies at x = -0.4: the image has the object
  // there alone, or the way through it.
  for (const bool way : {false, true}) {
    Tube tube(3, way, way);
    for (size_t i = 0; i < tube.image.values.size(); ++i) {
      tube.image.values[i] = (i % 2 == 1) == way ? 1.0F : 0.0F;
    }
    plc::ImageObject& object = tube.image.sizing.object;
    object.image.offset[0] = 0.5F;
    object.iso = way ? 0.3F : 0.7F;
    CHECK(tube.image.sizing.inside({0, 0, 4}) == way);
    CHECK(tube.image.sizing.inside({-0.4F, 0, 4}) == !way);
    CHECK(tube.denied(12).has_value() == way);
  }
}

TEST_CASE("four edges are denied around a way through the object alone", "[denied_cycles]") {
  CHECK_FALSE(Tube(4, false, false).denied(16).has_value());
  CHECK_FALSE(Tube(4, false, true).denied(16).has_value());
  CHECK_FALSE(Tube(4, true, false).denied(16).has_value());
  for (const uint32_t near : {16U, 17U}) {
    Tube pore(4, true, true);
    // What lies nearer to each other becomes an edge.
    for (const uint32_t v : {near, near + 2}) {
      plc::Float4& p = pore.mesh.position[v];
      p.x *= 0.9F;
      p.y *= 0.9F;
    }
    const auto candidate = pore.denied(16);
    REQUIRE(candidate.has_value());
    CHECK(corners_of(*candidate) == std::set<uint32_t>{16, 17, 18, 19});
    const plc::Cycle cycle = candidate->cycle();
    CHECK(std::set<uint32_t>{cycle.corner[0], cycle.corner[2]} ==
          std::set<uint32_t>{near, near + 2});
  }
}

TEST_CASE("what is denied of a cavity is so before and after it is turned inside out",
          "[denied_cycles]") {
  for (const uint32_t sides : {3U, 4U}) {
    for (const bool object : {false, true}) {
      const Tube turned(sides, true, object);
      Tube alone(sides, false, object);
      alone.mesh.inside_out = true;
      CHECK(alone.denied(4 * sides).has_value() == turned.denied(4 * sides).has_value());
    }
  }
}

TEST_CASE("cycles are looked for where an adaptive mesh bends", "[denied_cycles]") {
  Tube tube(3, false, false);
  REQUIRE(tube.denied(12).has_value());
  tube.mesh.sizing = nullptr;
  CHECK_FALSE(tube.denied(12).has_value());
}
