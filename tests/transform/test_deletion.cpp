#include "engine/transform/deletion.h"

#include <catch2/catch.hpp>

#include "engine/detect/tiny_components.h"
#include "engine/transform/creation.h"
#include "engine/transform/inversion.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Edge;
using plc::Mesh;

plc::Vector<uint32_t> listed(const plc::Neighbors& ring) {
  return {ring.begin(), ring.end()};
}

bool deletable(const Mesh& mesh, const Edge& e) {
  return plc::common_neighbors(mesh, e.u, e.v).size() == 2 && mesh.valence(e.a) > 3 &&
         mesh.valence(e.b) > 3;
}

// Creations and inversions at random, so that valences and separating cycles are many.
void stir(Mesh& mesh, samples::Random& random, int steps) {
  for (int i = 0; i < steps; ++i) {
    const auto u = static_cast<uint32_t>(random.integer(0, mesh.slots() - 1));
    if (!mesh.alive(u)) continue;
    const Edge e =
        plc::edge_at(mesh, u, static_cast<uint32_t>(random.integer(0, mesh.valence(u) - 1)));
    if (random.integer(0, 2) != 0 && mesh.valence(e.u) > 3 && mesh.valence(e.v) > 3 &&
        !mesh.adjacent(e.a, e.b)) {
      plc::invert_edge(mesh, e);
    } else {
      plc::create_on_edge(mesh, e);
    }
  }
}

}  // namespace

TEST_CASE("common neighbours stand in the order of the first ring", "[deletion]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  const Edge e = plc::edge_between(mesh, 0, 2);
  const auto common = listed(plc::common_neighbors(mesh, 0, 2));
  CHECK(common.size() == 2);
  CHECK(std::count(common.begin(), common.end(), e.a) == 1);
  CHECK(std::count(common.begin(), common.end(), e.b) == 1);
  // Opposite corners share all others, and are no neighbours.
  CHECK(listed(plc::common_neighbors(mesh, 0, 1)) == listed(mesh.ring(0)));
}

TEST_CASE("the two ends of an edge merge and the mesh stays closed", "[deletion]") {
  for (const samples::Soup& soup : {samples::octahedron(), samples::sphere(2),
                                    samples::bipyramid(13, 1), samples::torus(9, 7, 2, 0.7)}) {
    Mesh whole;
    samples::fill_mesh(whole, soup, 1);
    samples::for_each_edge(whole, [&](uint32_t u, uint32_t k) {
      for (const bool reversed : {false, true}) {
        Mesh mesh;
        samples::fill_mesh(mesh, soup, 1);
        const Edge e =
            reversed ? plc::edge_between(mesh, whole.neighbor(u, k), u) : plc::edge_at(mesh, u, k);
        if (!deletable(mesh, e)) continue;
        const auto merged = listed(plc::merged_ring(mesh, e));
        plc::delete_edge(mesh, e, plc::midpoint(mesh.at(e.u), mesh.at(e.v)));
        REQUIRE(plc::broken_invariant(mesh) == "");
        CHECK(mesh.vertex_count() + 1 == whole.vertex_count());
        CHECK(samples::euler(mesh) == samples::euler(whole));
        CHECK_FALSE(mesh.alive(e.v));
        CHECK(listed(mesh.ring(e.u)) == merged);
        CHECK(mesh.valence(e.u) + 4 == whole.valence(e.u) + whole.valence(e.v));
        CHECK(mesh.valence(e.a) + 1 == whole.valence(e.a));
        CHECK(mesh.valence(e.b) + 1 == whole.valence(e.b));
      }
    });
  }
}

TEST_CASE("the merged vertex goes where it is told, with the mean velocity", "[deletion]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  const Edge e = plc::edge_at(mesh, 30, 1);
  mesh.velocity.set(e.u, {1, 2, 3});
  mesh.velocity.set(e.v, {3, 2, 1});
  mesh.turns[e.u] = 0x80 + 4;
  mesh.turns[e.v] = 0x40 + 7;
  plc::delete_edge(mesh, e, {9, 8, 7});
  CHECK(mesh.at(e.u).x == 9);
  CHECK(mesh.at(e.u).y == 8);
  CHECK(mesh.velocity.at(e.u).x == 2);
  CHECK(mesh.velocity.at(e.u).z == 2);
  CHECK(mesh.turns[e.u] == 0x80 + 7);
  CHECK(mesh.create({}, {}) == e.v);
}

TEST_CASE("exactly two common neighbours and an apex of valence 3 mean a tetrahedron",
          "[deletion]") {
  samples::Random random(7);
  int tetrahedra = 0;
  for (int run = 0; run < 60; ++run) {
    Mesh mesh;
    samples::fill_mesh(mesh, run % 2 == 0 ? samples::tetrahedron() : samples::torus(3, 3, 2, 1), 1);
    stir(mesh, random, run);
    REQUIRE(plc::broken_invariant(mesh) == "");
    samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
      const Edge e = plc::edge_at(mesh, u, k);
      if (plc::common_neighbors(mesh, e.u, e.v).size() != 2) return;
      for (const uint32_t apex : {e.a, e.b}) {
        if (mesh.valence(apex) != 3) continue;
        CHECK(plc::is_tetrahedron(mesh, apex));
        ++tetrahedra;
      }
    });
  }
  CHECK(tetrahedra > 0);
}

TEST_CASE("an apex of valence 3 next to more common neighbours is no case for a deletion",
          "[deletion]") {
  // A vertex in a face of the octahedron: the face's corners have three common neighbours.
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 1);
  const Edge e = plc::edge_between(mesh, 0, 2);
  const uint32_t w = plc::create_on_edge(mesh, e);
  plc::invert_edge(mesh, plc::edge_between(mesh, w, e.b));
  REQUIRE(plc::broken_invariant(mesh) == "");
  REQUIRE(mesh.valence(w) == 3);
  REQUIRE(mesh.adjacent(e.u, e.v));
  CHECK(plc::common_neighbors(mesh, e.u, e.v).size() == 3);
  CHECK_FALSE(plc::is_tetrahedron(mesh, w));
}

TEST_CASE("a sphere of any kind shrinks to a tetrahedron by deletions", "[deletion]") {
  samples::Random random(8);
  for (int run = 0; run < 12; ++run) {
    Mesh mesh;
    samples::fill_mesh(mesh, samples::sphere(1), 1);
    stir(mesh, random, 40 * run);
    for (bool found = true; found;) {
      REQUIRE(plc::broken_invariant(mesh) == "");
      CHECK(samples::euler(mesh) == 2);
      std::vector<Edge> edges;
      samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
        const Edge e = plc::edge_at(mesh, u, k);
        if (deletable(mesh, e)) edges.push_back(e);
      });
      found = !edges.empty();
      if (!found) break;
      const auto pick = random.integer(0, static_cast<int64_t>(edges.size()) - 1);
      plc::delete_edge(mesh, edges[static_cast<size_t>(pick)], {});
    }
    // Steinitz: any other triangulation of the sphere has an edge that can be deleted.
    CHECK(mesh.vertex_count() == 4);
  }
}

TEST_CASE("a vertex of a long ring gives it up neighbour by neighbour", "[deletion]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::bipyramid(50, 1), 1);
  const uint32_t top = 51;
  while (mesh.valence(top) > 4) {
    const uint32_t u = mesh.neighbor(top, 0);
    const uint32_t v = mesh.neighbor(top, 1);
    plc::delete_edge(mesh, plc::edge_between(mesh, u, v), plc::midpoint(mesh.at(u), mesh.at(v)));
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(samples::euler(mesh) == 2);
  }
  CHECK(samples::meeting_count(mesh) == 0);
}

TEST_CASE("two long rings merge into one that is longer still", "[deletion]") {
  // Two fans of n share an edge between their hubs: the hubs merge to valence 2 n - 4.
  for (const uint32_t n : {6U, 7U, 8U, 13U, 16U, 24U}) {
    Mesh mesh;
    samples::fill_mesh(mesh, samples::octahedron(), 1);
    const Edge e = plc::edge_between(mesh, 0, 2);
    while (mesh.valence(e.u) < n) {
      const auto ring = mesh.ring(e.u);
      const uint32_t k = (ring.find(e.v) + 2) % ring.size();
      plc::create_on_edge(mesh, plc::edge_between(mesh, ring[k], ring.next(k)));
    }
    while (mesh.valence(e.v) < n) {
      const auto ring = mesh.ring(e.v);
      const uint32_t k = (ring.find(e.u) + 2) % ring.size();
      plc::create_on_edge(mesh, plc::edge_between(mesh, ring[k], ring.next(k)));
    }
    REQUIRE(plc::broken_invariant(mesh) == "");
    const Edge now = plc::edge_between(mesh, e.u, e.v);
    REQUIRE(deletable(mesh, now));
    const uint32_t expected = mesh.valence(e.u) + mesh.valence(e.v) - 4;
    plc::delete_edge(mesh, now, {});
    CHECK(mesh.valence(e.u) == expected);
    CHECK(plc::broken_invariant(mesh) == "");
  }
}
