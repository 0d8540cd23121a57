#include "engine/measure/mesh_topology.h"

#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <utility>
#include <vector>

#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_meshes.h"

namespace {

plc::MeshTopology topology(const plc::Vector<uint32_t>& abc, size_t vertices) {
  const plc::EdgeTable edges(abc.data(), abc.size() / 3, vertices, plc::SerialExecutor());
  return plc::mesh_topology(abc.data(), abc.size() / 3, vertices, edges,
                            fixtures::ThreadExecutor(3));
}

}  // namespace

TEST_CASE("the edge table lists every edge once with all its uses in order", "[mesh_topology]") {
  std::mt19937 bits(1);
  constexpr uint32_t kVertices = 40;
  plc::Vector<uint32_t> abc(3 * 200);
  for (uint32_t& v : abc) v = static_cast<uint32_t>(bits() % kVertices);
  std::map<std::pair<uint32_t, uint32_t>, plc::Vector<uint32_t>> want;
  for (uint32_t c = 0; c < abc.size(); ++c) {
    const uint32_t f = c / 3 * 3;
    if (abc[f] == abc[f + 1] || abc[f + 1] == abc[f + 2] || abc[f + 2] == abc[f]) continue;
    const uint32_t a = abc[c], b = abc[f + (c + 1) % 3];
    want[{std::min(a, b), std::max(a, b)}].push_back(c);
  }
  const plc::EdgeTable edges(abc.data(), abc.size() / 3, kVertices, plc::SerialExecutor());
  auto next = want.begin();
  edges.visit(0, kVertices,
              [&](uint32_t low, uint32_t high, const plc::EdgeUse* use, const plc::EdgeUse* end) {
                REQUIRE(next != want.end());
                CHECK(next->first == std::make_pair(low, high));
                plc::Vector<uint32_t> corners;
                for (; use != end; ++use) corners.push_back(use->corner);
                CHECK(corners == next->second);
                ++next;
              });
  CHECK(next == want.end());
}

TEST_CASE("components are numbered by their first faces", "[mesh_topology]") {
  samples::Soup m = samples::octahedron();
  m.append(samples::cube());
  m.face(6, 6, 7);
  const plc::MeshTopology t = topology(m.abc, m.vertex_count());
  REQUIRE(t.components.size() == 3);
  CHECK(t.components[0].faces == 8);
  CHECK(t.components[1].first_face == 8);
  CHECK(t.components[1].edges == 18);
  CHECK(t.components[1].vertices == 8);
  CHECK(t.components[1].genus() == 0);
  CHECK(t.components[2].genus() == -1);
  CHECK(t.repeated_vertex_faces == 1);
  CHECK(t.euler == 4);
}

TEST_CASE("a Moebius strip is manifold, of one component, and inconsistent somewhere",
          "[mesh_topology]") {
  plc::Vector<uint32_t> abc;
  constexpr uint32_t kSteps = 9;
  for (uint32_t i = 0; i < kSteps; ++i) {
    const bool last = i + 1 == kSteps;
    const uint32_t a = 2 * i, b = 2 * i + 1, c = last ? 1 : 2 * i + 2, d = last ? 0 : 2 * i + 3;
    abc.insert(abc.end(), {a, c, b, b, c, d});
  }
  const plc::MeshTopology t = topology(abc, 2 * kSteps);
  CHECK(t.components.size() == 1);
  CHECK(t.non_manifold_edges == 0);
  CHECK(t.non_manifold_vertices == 0);
  CHECK(t.border_edges == 2 * kSteps);
  CHECK(t.inconsistent_edges == 1);
  CHECK(t.euler == 0);
  CHECK(t.components[0].genus() == -1);
}

TEST_CASE(
    "a vertex where three cones meet counts once as non-manifold and three times in its "
    "components",
    "[mesh_topology]") {
  const plc::Vector<uint32_t> abc = {0, 1, 2, 0, 3, 4, 0, 5, 6};
  const plc::MeshTopology t = topology(abc, 8);
  CHECK(t.non_manifold_vertices == 1);
  CHECK(t.isolated_vertices == 1);
  CHECK(t.components.size() == 3);
  CHECK(t.euler == 7 - 9 + 3);
  CHECK(t.valence_min == 2);
  CHECK(t.valence_max == 6);
}
