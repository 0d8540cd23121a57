#include "engine/transform/inversion.h"

#include <catch2/catch.hpp>

#include "engine/transform/creation.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Edge;
using plc::Mesh;

}  // namespace

TEST_CASE("an inverted edge joins the apexes and leaves a closed mesh", "[inversion]") {
  for (const samples::Soup& soup :
       {samples::octahedron(), samples::sphere(2), samples::torus(9, 7, 2, 0.7)}) {
    Mesh whole;
    samples::fill_mesh(whole, soup, 1);
    samples::for_each_edge(whole, [&](uint32_t u, uint32_t k) {
      Mesh mesh;
      samples::fill_mesh(mesh, soup, 1);
      const Edge e = plc::edge_at(mesh, u, k);
      if (!plc::can_invert(mesh, e)) return;
      plc::invert_edge(mesh, e);
      REQUIRE(plc::broken_invariant(mesh) == "");
      CHECK(mesh.adjacent(e.a, e.b));
      CHECK_FALSE(mesh.adjacent(e.u, e.v));
      CHECK(samples::euler(mesh) == samples::euler(whole));
      CHECK(mesh.valence(e.u) + 1 == whole.valence(e.u));
      CHECK(mesh.valence(e.v) + 1 == whole.valence(e.v));
      CHECK(mesh.valence(e.a) == whole.valence(e.a) + 1);
      CHECK(mesh.valence(e.b) == whole.valence(e.b) + 1);
      const Edge back = plc::edge_between(mesh, e.a, e.b);
      CHECK(((back.a == e.v && back.b == e.u) || (back.a == e.u && back.b == e.v)));
      plc::invert_edge(mesh, back);
      CHECK(samples::sorted_faces(mesh) == samples::sorted_faces(whole));
    });
  }
}

TEST_CASE("ends of three neighbours keep their edges", "[inversion]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tetrahedron(), 1);
  samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
    CHECK_FALSE(plc::can_invert(mesh, plc::edge_at(mesh, u, k)));
  });
  samples::fill_mesh(mesh, samples::bipyramid(3, 1), 1);
  for (uint32_t k = 0; k < 3; ++k) CHECK_FALSE(plc::can_invert(mesh, plc::edge_at(mesh, 4, k)));
}

TEST_CASE("an edge whose apexes are neighbours is not inverted", "[inversion]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::bipyramid(6, 1), 1);
  const Edge first = plc::edge_between(mesh, 0, 1);
  REQUIRE(plc::can_invert(mesh, first));
  plc::invert_edge(mesh, first);
  CHECK(mesh.adjacent(6, 7));
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK_FALSE(plc::can_invert(mesh, plc::edge_between(mesh, 2, 3)));
}

TEST_CASE("an inversion that would turn a face over is refused", "[inversion]") {
  // A flat quadrilateral u a v b on top of a bipyramid, with its corner v pushed in past a-b.
  samples::Soup soup = samples::bipyramid(4, 0);
  soup.xyz[3 * 5 + 2] = 0.5;
  soup.xyz[3 * 4 + 2] = -0.5;
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  // Edge from ring vertex 0 to the top: apexes 1 and 3.
  const Edge e = plc::edge_between(mesh, 0, 5);
  mesh.place(5, {0.2F, 0, 0.01F});
  mesh.place(4, {0, 0, -0.5F});
  CHECK(plc::can_invert(mesh, e) == plc::can_invert(mesh, plc::edge_between(mesh, 5, 0)));
  mesh.place(1, {-0.3F, 1, 0});
  mesh.place(3, {-0.3F, -1, 0});
  // Now 1-3 runs behind the top: the face (top, 1, 3) would look down.
  CHECK_FALSE(plc::can_invert(mesh, e));
  mesh.place(1, {0.6F, 1, 0});
  mesh.place(3, {0.6F, -1, 0});
  CHECK(plc::can_invert(mesh, e));
}

TEST_CASE("inversions and creations at random keep the mesh closed and of one topology",
          "[inversion]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::torus(10, 6, 3, 1), 1);
  samples::Random random(6);
  int inverted = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto u = static_cast<uint32_t>(random.integer(0, mesh.slots() - 1));
    const auto k = static_cast<uint32_t>(random.integer(0, mesh.valence(u) - 1));
    const Edge e = plc::edge_at(mesh, u, k);
    // Also where a face turns over: the combinatorial conditions alone keep the mesh closed.
    if (mesh.valence(e.u) > 3 && mesh.valence(e.v) > 3 && !mesh.adjacent(e.a, e.b)) {
      plc::invert_edge(mesh, e);
      ++inverted;
    } else {
      plc::create_on_edge(mesh, e);
    }
    if (i % 100 == 0) REQUIRE(plc::broken_invariant(mesh) == "");
  }
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(samples::euler(mesh) == 0);
  CHECK(inverted > 1000);
  uint32_t longest = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) longest = std::max(longest, mesh.valence(v));
  CHECK(longest > plc::kRingSlots);
}
