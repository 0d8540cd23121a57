#include "engine/transform/creation.h"

#include <catch2/catch.hpp>

#include "pyramid/memory.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"
#include "tests/samples/sample_woken.h"

namespace {

using plc::Edge;
using plc::Mesh;

std::vector<std::pair<uint32_t, uint32_t>> edges_of(const Mesh& mesh) {
  std::vector<std::pair<uint32_t, uint32_t>> edges;
  samples::for_each_edge(
      mesh, [&](uint32_t u, uint32_t k) { edges.emplace_back(u, mesh.neighbor(u, k)); });
  return edges;
}

}  // namespace

TEST_CASE("a creation on any edge leaves a closed mesh of the same topology", "[creation]") {
  for (const samples::Soup& soup : {samples::tetrahedron(), samples::octahedron(),
                                    samples::bipyramid(14, 1), samples::torus(7, 4, 2, 0.6)}) {
    Mesh whole;
    samples::fill_mesh(whole, soup, 1);
    for (const auto& [u, v] : edges_of(whole)) {
      Mesh mesh;
      samples::fill_mesh(mesh, soup, 1);
      plc::create_on_edge(mesh, plc::edge_between(mesh, u, v));
      REQUIRE(plc::broken_invariant(mesh) == "");
      CHECK(mesh.vertex_count() == whole.vertex_count() + 1);
      CHECK(samples::euler(mesh) == samples::euler(whole));
      CHECK(samples::meeting_count(mesh) == 0);
      CHECK(samples::volume(mesh) == Approx(samples::volume(whole)));
    }
  }
}

TEST_CASE("the new vertex lies between the ends and the apexes, which alone change", "[creation]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  const uint32_t u = 20;
  const Edge e = plc::edge_at(mesh, u, 2);
  mesh.velocity.set(u, {2, 0, 4});
  mesh.velocity.set(e.v, {0, 6, 0});
  mesh.turns[u] = 0x80 + 4;
  mesh.turns[e.v] = 0x40 + 7;
  plc::Vector<uint32_t> valences;
  for (uint32_t v = 0; v < mesh.slots(); ++v) valences.push_back(mesh.valence(v));
  const samples::Woken woken(mesh);
  const uint32_t w = plc::create_on_edge(mesh, e);
  CHECK(w == 66);
  CHECK(mesh.valence(w) == 4);
  for (const uint32_t x : {e.u, e.v, e.a, e.b}) CHECK(mesh.adjacent(w, x));
  CHECK_FALSE(mesh.adjacent(e.u, e.v));
  CHECK(plc::squared_distance(mesh.at(w), plc::midpoint(mesh.at(u), mesh.at(e.v))) == 0);
  CHECK(mesh.velocity.at(w).x == 1);
  CHECK(mesh.velocity.at(w).y == 3);
  CHECK(mesh.velocity.at(w).z == 2);
  CHECK(mesh.turns[w] == 6);
  CHECK(woken[w]);
  for (uint32_t v = 0; v < w; ++v) {
    CHECK(mesh.valence(v) == valences[v] + (v == e.a || v == e.b ? 1U : 0U));
  }
}

TEST_CASE("creations around one vertex carry it across the ends of its columns and tails",
          "[creation]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::bipyramid(5, 1), 1);
  const uint32_t apex = 6;
  // Each creation on the ring's edges adds a neighbour to both apexes.
  for (uint32_t valence = 5; valence < 60; ++valence) {
    REQUIRE(mesh.valence(apex) == valence);
    const uint32_t u = mesh.neighbor(apex, valence % 5);
    const uint32_t v = mesh.neighbor(apex, (valence % 5 + 1) % valence);
    plc::create_on_edge(mesh, plc::edge_between(mesh, u, v));
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(samples::euler(mesh) == 2);
  }
  CHECK(samples::meeting_count(mesh) == 0);
}

TEST_CASE("thousands of creations at random keep the mesh closed", "[creation]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::torus(6, 4, 3, 1), 1);
  samples::Random random(5);
  for (int i = 0; i < 3000; ++i) {
    const auto u = static_cast<uint32_t>(random.integer(0, mesh.slots() - 1));
    const auto k = static_cast<uint32_t>(random.integer(0, mesh.valence(u) - 1));
    plc::create_on_edge(mesh, plc::edge_at(mesh, u, k));
  }
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(samples::euler(mesh) == 0);
}
