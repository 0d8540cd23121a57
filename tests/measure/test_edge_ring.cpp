#include "engine/measure/edge_ring.h"

#include <catch2/catch.hpp>
#include <set>

#include "pyramid/memory.h"
#include "tests/samples/sample_shapes.h"

namespace {

using samples::Soup;

plc::EdgeRings rings(const Soup& m) {
  return {m.abc.data(), m.face_count(), m.vertex_count(), plc::SerialExecutor()};
}

plc::Vector<uint8_t> bends(const Soup& m) {
  const plc::VertexCorners corners(m.abc.data(), m.face_count(), m.vertex_count());
  return plc::bending_vertices(m.arrays(), corners, rings(m));
}

}  // namespace

TEST_CASE("corners across an edge of a closed surface are each other's", "[edge_ring]") {
  const Soup m = samples::torus(9, 7, 2, 0.6);
  const plc::EdgeRings edges = rings(m);
  for (uint32_t c = 0; c < m.abc.size(); ++c) {
    const uint32_t o = edges.across(c);
    REQUIRE(o != c);
    CHECK(edges.across(o) == c);
    const auto ends = [&](uint32_t corner) {
      return std::set<uint32_t>{m.abc[plc::next_corner(corner)],
                                m.abc[plc::previous_corner(corner)]};
    };
    CHECK(ends(o) == ends(c));
  }
}

TEST_CASE("an edge of three faces is one ring of three corners, a border one of one",
          "[edge_ring]") {
  Soup m;
  m.xyz = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, -1, 0, 0};
  m.abc = {0, 1, 2, 0, 1, 3, 1, 0, 4, 2, 2, 3};
  const plc::EdgeRings edges = rings(m);
  const uint32_t second = edges.across(2), third = edges.across(second);
  CHECK(std::set<uint32_t>{2, second, third} == std::set<uint32_t>{2, 5, 8});
  CHECK(edges.across(third) == 2);
  for (const uint32_t c : {0U, 1U, 3U, 4U, 6U, 7U, 9U, 10U, 11U}) CHECK(edges.across(c) == c);
}

TEST_CASE("corners around a vertex are all of its faces', ascending", "[edge_ring]") {
  Soup m = samples::sphere(1);
  m.face(0, 0, 1);  // repeats a vertex
  const plc::VertexCorners corners(m.abc.data(), m.face_count(), m.vertex_count());
  size_t total = 0;
  for (uint32_t v = 0; v < m.vertex_count(); ++v) {
    uint32_t last = 0;
    for (const uint32_t c : corners.of(v)) {
      CHECK(m.abc[c] == v);
      CHECK(c >= last);
      last = c;
      ++total;
    }
  }
  CHECK(total == m.abc.size() - 3);
}

TEST_CASE("paths bend at saddles and reflex borders, not on what is convex or flat",
          "[edge_ring]") {
  for (const uint8_t b : bends(samples::cube())) CHECK(b == 0);
  const Soup sheet = samples::turned(samples::sheet(6, 0.3));
  for (const uint8_t b : bends(sheet)) CHECK(b == 0);  // straight borders and corners too
  Soup notch = samples::sheet(2, 0);
  notch.abc.erase(notch.abc.begin(), notch.abc.begin() + 6);
  const plc::Vector<uint8_t> at_notch = bends(notch);
  for (size_t v = 0; v < 9; ++v) CHECK(at_notch[v] == (v == 4 ? 1 : 0));
  const Soup torus = samples::torus(30, 20, 2, 0.6);
  const plc::Vector<uint8_t> around = bends(torus);
  for (size_t v = 0; v < around.size(); ++v) {
    const size_t j = v % 20;  // 0 outside, 10 at the hole
    if (j < 4 || j > 16) CHECK(around[v] == 0);
    if (j > 6 && j < 14) CHECK(around[v] == 1);
  }
}

TEST_CASE("paths bend where two surfaces touch, at edges of several faces and at slivers",
          "[edge_ring]") {
  Soup touching;  // two sharp tetrahedra with vertex 0 in common: less than 360 degrees together
  touching.xyz = {0, 0, 0, 1, 0, 9, 0, 1, 9, 0, 0, 10, 1, 0, -9, 0, 1, -9, 0, 0, -10};
  touching.abc = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 0, 4, 5, 0, 6, 4, 0, 5, 6, 4, 6, 5};
  const plc::Vector<uint8_t> at = bends(touching);
  CHECK(at[0] == 1);
  CHECK(at[1] == 0);
  Soup fins;
  fins.xyz = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, -1, 0, 0};
  fins.abc = {0, 1, 2, 0, 1, 3, 1, 0, 4};
  CHECK(bends(fins) == plc::Vector<uint8_t>{1, 1, 0, 0, 0});
  Soup sliver;
  sliver.xyz = {0, 0, 0, 1, 0, 0, 2, 0, 0};
  sliver.abc = {0, 1, 2};
  CHECK(bends(sliver) == plc::Vector<uint8_t>{1, 1, 1});
}
