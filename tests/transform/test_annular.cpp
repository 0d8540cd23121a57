#include "engine/transform/annular.h"

#include <catch2/catch.hpp>

#include "engine/base/constants.h"
#include "engine/transform/candidate.h"
#include "engine/transform/deletion.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Cycle;
using plc::Mesh;
using plc::Vec3;

// All cycles of three edges that are no face, each in one direction from its smallest corner.
std::vector<Cycle> cycles_of(const Mesh& mesh) {
  std::vector<Cycle> cycles;
  samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
    const plc::Edge e = plc::edge_at(mesh, u, k);
    for (const uint32_t o : plc::common_neighbors(mesh, e.u, e.v)) {
      if (o != e.a && o != e.b && o > e.v) cycles.push_back({{e.u, e.v, o}});
    }
  });
  return cycles;
}

void cut(Mesh& mesh, const Cycle& cycle) {
  plc::cut_cycle(mesh, cycle, plc::annular_copies(mesh, cycle, plc::kAnnularRetreat), 1, 1);
}

}  // namespace

TEST_CASE("a torus cut across its thin tube becomes a sphere", "[annular]") {
  const samples::Soup soup = samples::torus(12, 3, 3, 0.3);
  Mesh whole;
  samples::fill_mesh(whole, soup, 1);
  const std::vector<Cycle> cycles = cycles_of(whole);
  REQUIRE(cycles.size() == 12);
  for (const Cycle& cycle : cycles) {
    Mesh mesh;
    samples::fill_mesh(mesh, soup, 1);
    cut(mesh, cycle);
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(mesh.vertex_count() == whole.vertex_count() + 3);
    CHECK(samples::euler(mesh) == 2);
    CHECK(samples::component_count(mesh) == 1);
    CHECK(samples::meeting_count(mesh) == 0);
    CHECK(samples::volume(mesh) > 0);
  }
}

TEST_CASE("a tube cut at any place becomes two closed tubes", "[annular]") {
  const samples::Soup soup = samples::tube(3, 7, 0.5);
  Mesh whole;
  samples::fill_mesh(whole, soup, 1);
  const std::vector<Cycle> cycles = cycles_of(whole);
  REQUIRE(cycles.size() == 7);
  for (const Cycle& cycle : cycles) {
    for (const bool reversed : {false, true}) {
      Mesh mesh;
      samples::fill_mesh(mesh, soup, 1);
      Cycle walked = cycle;
      if (reversed) std::swap(walked.corner[1], walked.corner[2]);
      cut(mesh, walked);
      REQUIRE(plc::broken_invariant(mesh) == "");
      CHECK(samples::euler(mesh) == 4);
      CHECK(samples::component_count(mesh) == 2);
      CHECK(samples::meeting_count(mesh) == 0);
      CHECK(samples::volume(mesh) > 0);
      CHECK(samples::volume(mesh) < samples::volume(whole));
    }
  }
}

TEST_CASE("a tube can be cut all the way into slices", "[annular]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tube(3, 9, 0.5), 1);
  for (int64_t pieces = 1;; ++pieces) {
    CHECK(samples::component_count(mesh) == pieces);
    CHECK(samples::euler(mesh) == 2 * pieces);
    const std::vector<Cycle> cycles = cycles_of(mesh);
    if (cycles.empty()) break;
    cut(mesh, cycles[cycles.size() / 2]);
    REQUIRE(plc::broken_invariant(mesh) == "");
  }
  // Each of the 9 cross-sections was cut: pieces without separating cycles are left.
  CHECK(samples::component_count(mesh) == 10);
}

TEST_CASE("the copies retreat towards their own side and remember the cut", "[annular]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tube(3, 5, 0.5), 1);
  // The middle cross-section, left side up or down.
  const Cycle cycle{{6, 7, 8}};
  const auto copies = plc::annular_copies(mesh, cycle, plc::kAnnularRetreat);
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t v = cycle.corner[i];
    for (const auto& side : copies) {
      const plc::CutCopy& copy = side[i];
      Vec3 mean;
      for (const uint32_t w : copy.arc) {
        mean = mean + mesh.at(w) * (1.0F / static_cast<float>(copy.arc.size()));
        CHECK(mesh.adjacent(v, w));
        CHECK(std::count(cycle.corner.begin(), cycle.corner.end(), w) == 0);
      }
      const Vec3 expected = mesh.at(v) + (mean - mesh.at(v)) * plc::kAnnularRetreat;
      CHECK(plc::length(copy.place - expected) < 1e-6F);
      const bool above = copy.arc[0] > 8;
      CHECK((copy.place.z > 2) == above);
      CHECK(above == (side[0].arc[0] > 8));
    }
    CHECK(copies[0][i].arc.size() + copies[1][i].arc.size() + 2 == mesh.valence(v));
  }
  for (const uint32_t v : cycle.corner) {
    mesh.velocity.set(v, {static_cast<float>(v), 0, 1});
    mesh.turns[v] = static_cast<uint8_t>(0x40 + v);
  }
  const auto right = plc::cut_cycle(mesh, cycle, copies, 77, 12);
  for (size_t i = 0; i < 3; ++i) {
    const uint32_t v = cycle.corner[i];
    CHECK(right[i] == mesh.slots() - 3 + i);
    CHECK(mesh.velocity.at(right[i]).x == static_cast<float>(v));
    CHECK(mesh.turns[v] == 0x40 + v + plc::kTransformationTurns);
    CHECK(mesh.turns[right[i]] == v + plc::kTransformationTurns);
    for (const uint32_t copy : {v, right[i]}) {
      CHECK(mesh.cut_id[copy] == 77);
      CHECK(mesh.cut_iteration[copy] == 12);
      CHECK(mesh.valence(copy) >= 3);
    }
    CHECK(plc::squared_distance(mesh.at(v), copies[0][i].place) == 0);
    CHECK(plc::squared_distance(mesh.at(right[i]), copies[1][i].place) == 0);
    CHECK_FALSE(mesh.adjacent(v, right[i]));
  }
}

TEST_CASE("a tube is cut along a cycle of four edges, closed by two faces on either side",
          "[annular]") {
  const samples::Soup soup = samples::tube(4, 5, 0.5);
  for (uint32_t first = 0; first < 4; ++first) {
    for (const uint32_t step : {1U, 3U}) {
      Mesh mesh;
      samples::fill_mesh(mesh, soup, 1);
      // The middle cross-section.
      Cycle cycle{{}, 4};
      for (uint32_t i = 0; i < 4; ++i) cycle.corner[i] = 8 + (first + i * step) % 4;
      const auto copies = plc::annular_copies(mesh, cycle, plc::kAnnularRetreat);
      const auto right = plc::cut_cycle(mesh, cycle, copies, 1, 1);
      REQUIRE(plc::broken_invariant(mesh) == "");
      CHECK(samples::euler(mesh) == 4);
      CHECK(samples::component_count(mesh) == 2);
      CHECK(samples::meeting_count(mesh) == 0);
      CHECK(samples::volume(mesh) > 0);
      for (const auto& copy : {cycle.corner, right}) {
        CHECK(mesh.adjacent(copy[0], copy[2]));
        CHECK_FALSE(mesh.adjacent(copy[1], copy[3]));
      }
    }
  }
}

TEST_CASE("a bump of valence 3 is cut off as a tetrahedron", "[annular]") {
  // The apex of a tube of one cross-section more than the rest: its ring is a separating cycle.
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tube(3, 2, 0.5), 1);
  const std::vector<Cycle> cycles = cycles_of(mesh);
  REQUIRE(cycles.size() == 2);
  cut(mesh, cycles[1]);
  REQUIRE(plc::broken_invariant(mesh) == "");
  CHECK(samples::component_count(mesh) == 2);
  int tetrahedra = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    bool all = mesh.valence(v) == 3;
    for (uint32_t k = 0; all && k < 3; ++k) all = mesh.valence(mesh.neighbor(v, k)) == 3;
    tetrahedra += all ? 1 : 0;
  }
  CHECK(tetrahedra == 4);
}

TEST_CASE("a cut through a vertex of a long ring shares its neighbours out", "[annular]") {
  // A cycle around the middle of a torus: hubs of valence 40 on both sides of it.
  samples::Soup soup = samples::torus(3, 20, 3, 1);
  Mesh whole;
  samples::fill_mesh(whole, soup, 1);
  const std::vector<Cycle> cycles = cycles_of(whole);
  REQUIRE(cycles.size() == 20);
  for (const Cycle& cycle : cycles) {
    Mesh mesh;
    samples::fill_mesh(mesh, soup, 1);
    cut(mesh, cycle);
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(samples::euler(mesh) == 2);
  }
}

TEST_CASE("of cycles over the same edge each has a place in the order", "[annular]") {
  const plc::Candidate three = plc::cut_along({{1, 2, 3}}, 1),
                       other = plc::cut_along({{1, 2, 4}}, 1);
  const plc::Candidate four = plc::cut_along({{1, 2, 3, 5}, 4}, 1);
  for (const auto& [l, r] :
       {std::pair(three, other), std::pair(four, other), std::pair(four, three)}) {
    CHECK(l < r);
    CHECK_FALSE(r < l);
  }
  CHECK_FALSE(three < three);
  CHECK(three.cycle().size == 3);
  CHECK(four.cycle().size == 4);
}
