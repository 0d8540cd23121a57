#include "engine/transform/axial.h"

#include <catch2/catch.hpp>

#include "engine/base/constants.h"
#include "engine/mesh/turns.h"
#include "engine/transform/deletion.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::AxialPlan;
using plc::Mesh;
using samples::Soup;

// Runs of common neighbours that follow one another around u: the groups of figure 3.
int groups_of_common_neighbors(const Mesh& mesh, uint32_t u, uint32_t v) {
  const auto ring = mesh.ring(u);
  int groups = 0;
  bool all = true;
  for (uint32_t k = 0; k < ring.size(); ++k) {
    const bool here = mesh.adjacent(ring[k], v);
    const bool before = mesh.adjacent(ring.previous(k), v);
    groups += here && !before ? 1 : 0;
    all = all && here;
  }
  return all ? 1 : groups;
}

// Joins every pair of vertices that are no neighbours, each in a mesh of its own; counts pairs by
// their groups of common neighbours.
std::vector<int> join_all(const Soup& soup) {
  Mesh whole;
  samples::fill_mesh(whole, soup, 1);
  std::vector<int> counts(4, 0);
  for (uint32_t u = 0; u < whole.slots(); ++u) {
    for (uint32_t v = 0; v < whole.slots(); ++v) {
      if (u == v || whole.adjacent(u, v)) continue;
      Mesh mesh;
      samples::fill_mesh(mesh, soup, 1);
      const uint32_t sum = mesh.valence(u) + mesh.valence(v);
      const auto created = plc::join(mesh, plc::plan_axial(mesh, u, v));
      CAPTURE(u, v);
      REQUIRE(plc::broken_invariant(mesh) == "");
      CHECK(samples::euler(mesh) == samples::euler(whole) - 2);
      CHECK(created.size() == sum);
      CHECK(mesh.vertex_count() + 2 == whole.vertex_count() + sum);
      ++counts[static_cast<size_t>(groups_of_common_neighbors(whole, u, v))];
    }
  }
  return counts;
}

// Two unit spheres, their poles facing each other across a gap along z.
Soup facing_spheres(int levels, double gap) {
  Soup m = samples::sphere(levels);
  m.append(samples::moved(samples::sphere(levels), 0, 0, 2 + gap));
  return m;
}

uint32_t at_place(const Mesh& mesh, double x, double y, double z) {
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const plc::Vec3 p{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    if (mesh.alive(v) && plc::length(mesh.at(v) - p) < 1e-5F) return v;
  }
  return ~0U;
}

}  // namespace

TEST_CASE("two spheres that face each other become one", "[axial]") {
  for (const int levels : {1, 2, 3}) {
    Mesh mesh;
    samples::fill_mesh(mesh, facing_spheres(levels, 0.2), 1);
    const uint32_t u = at_place(mesh, 0, 0, 1);
    const uint32_t v = at_place(mesh, 0, 0, 1.2);
    const double before = samples::volume(mesh);
    plc::join(mesh, plc::plan_axial(mesh, u, v));
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(samples::euler(mesh) == 2);
    CHECK(samples::component_count(mesh) == 1);
    CHECK(samples::meeting_count(mesh) == 0);
    CHECK(samples::volume(mesh) > before);  // the neck is more than the caps it takes
    CHECK_FALSE(mesh.alive(u));
    CHECK_FALSE(mesh.alive(v));
  }
}

TEST_CASE("the poles of a flat sphere join to a torus", "[axial]") {
  Soup soup = samples::sphere(2);
  for (size_t i = 2; i < soup.xyz.size(); i += 3) soup.xyz[i] *= 0.2;
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  const uint32_t u = at_place(mesh, 0, 0, 0.2);
  const uint32_t v = at_place(mesh, 0, 0, -0.2);
  const double before = samples::volume(mesh);
  plc::join(mesh, plc::plan_axial(mesh, u, v));
  REQUIRE(plc::broken_invariant(mesh) == "");
  CHECK(samples::euler(mesh) == 0);
  CHECK(samples::component_count(mesh) == 1);
  CHECK(samples::meeting_count(mesh) == 0);
  CHECK(samples::volume(mesh) < before);
}

TEST_CASE("any two vertices join, with no, one or two groups of common neighbours", "[axial]") {
  // Figure 3. The graph stays simple whatever the two rings share.
  const auto sphere = join_all(samples::sphere(1));
  CHECK(sphere[0] > 0);
  CHECK(sphere[1] > 0);
  const auto tube = join_all(samples::tube(4, 4, 0.6));
  CHECK(tube[0] > 0);
  CHECK(tube[1] > 0);
  CHECK(tube[2] > 0);
  const auto torus = join_all(samples::torus(4, 4, 2, 0.5));
  CHECK(torus[2] > 0);
  CHECK(join_all(samples::octahedron())[1] == 6);
  join_all(samples::bipyramid(3, 1));
  join_all(samples::bipyramid(12, 1));
  join_all(samples::torus(3, 5, 2, 0.5));
  join_all(samples::tube(3, 3, 0.5));
}

TEST_CASE("vertices of two components join with any valences", "[axial]") {
  for (uint32_t d = 3; d <= 14; ++d) {
    for (const uint32_t e : {3U, 4U, 7U, 11U, 12U, 28U, 44U}) {
      Soup soup = samples::bipyramid(d, 0.3);
      soup.append(samples::moved(samples::bipyramid(e, 0.3), 0.05, 0.03, 1));
      Mesh mesh;
      samples::fill_mesh(mesh, soup, 1);
      const uint32_t u = d + 1;      // top of the first
      const uint32_t v = d + 2 + e;  // bottom of the second
      plc::join(mesh, plc::plan_axial(mesh, u, v));
      CAPTURE(d, e);
      REQUIRE(plc::broken_invariant(mesh) == "");
      CHECK(samples::euler(mesh) == 2);
      CHECK(samples::component_count(mesh) == 1);
    }
  }
}

TEST_CASE("intermediary vertices lie on the edges at the given reach and take over", "[axial]") {
  Mesh mesh;
  samples::fill_mesh(mesh, facing_spheres(2, 0.2), 1);
  const uint32_t u = at_place(mesh, 0, 0, 1);
  const uint32_t v = at_place(mesh, 0, 0, 1.2);
  mesh.velocity.set(u, {4, 0, 0});
  mesh.turns[u] = 0x80 + 4;
  mesh.turns[v] = plc::kFrozenTurns;
  const AxialPlan plan = plc::plan_axial(mesh, u, v);
  REQUIRE(plan.p.size() == mesh.valence(u));
  REQUIRE(plan.q.size() == mesh.valence(v));
  for (uint32_t i = 0; i < plan.p.size(); ++i) {
    const plc::Vec3 expected =
        mesh.at(u) + (mesh.at(plan.ring_u[i]) - mesh.at(u)) * plc::kAxialReach;
    CHECK(plc::squared_distance(plan.p[i], expected) == 0);
  }
  const auto created = plc::join(mesh, plan);
  for (uint32_t i = 0; i < created.size(); ++i) {
    const bool of_u = i < plan.p.size();
    const plc::Vec3 place = of_u ? plan.p[i] : plan.q[i - plan.p.size()];
    CHECK(plc::squared_distance(mesh.at(created[i]), place) == 0);
    CHECK(mesh.velocity.at(created[i]).x == (of_u ? 4 * (1 - plc::kAxialReach) : 0));
    CHECK(mesh.turns[created[i]] == (of_u ? 4 + plc::kTransformationTurns : plc::kFrozenTurns));
    CHECK(mesh.valence(created[i]) >= 5);
  }
}

TEST_CASE("neighbours of both vertices that are neighbours of long rings stay consistent",
          "[axial]") {
  // Both apexes of a bipyramid share all of their ring; the rings' vertices gain two each.
  for (const uint32_t n : {3U, 5U, 11U, 12U, 27U, 28U}) {
    Mesh mesh;
    samples::fill_mesh(mesh, samples::bipyramid(n, 0.2), 1);
    plc::join(mesh, plc::plan_axial(mesh, n, n + 1));
    CAPTURE(n);
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(samples::euler(mesh) == 0);
  }
}

TEST_CASE("joining again and again makes handles, each lowering Euler's number by two", "[axial]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  samples::Random random(13);
  int64_t expected = 2;
  for (int joined = 0; joined < 25;) {
    const auto u = static_cast<uint32_t>(random.integer(0, mesh.slots() - 1));
    const auto v = static_cast<uint32_t>(random.integer(0, mesh.slots() - 1));
    if (u == v || !mesh.alive(u) || !mesh.alive(v) || mesh.adjacent(u, v)) continue;
    plc::join(mesh, plc::plan_axial(mesh, u, v));
    ++joined;
    expected -= 2;
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(samples::euler(mesh) == expected);
  }
}
