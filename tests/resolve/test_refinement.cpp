#include "engine/resolve/refinement.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/transform/creation.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"
#include "tests/samples/sample_woken.h"

namespace {

using plc::Mesh;
using samples::Soup;

double mean_edge(const Mesh& mesh) {
  double sum = 0;
  int64_t count = 0;
  samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
    sum += static_cast<double>(plc::length(mesh.at(u) - mesh.at(mesh.neighbor(u, k))));
    ++count;
  });
  return sum / static_cast<double>(count);
}

}  // namespace

TEST_CASE("refinement triples the faces and keeps topology, volume and embedding", "[refinement]") {
  for (const Soup& soup :
       {samples::tetrahedron(), samples::octahedron(), samples::sphere(2),
        samples::bipyramid(17, 1), samples::torus(12, 8, 3, 1), samples::tube(3, 4, 0.5)}) {
    Mesh mesh;
    samples::fill_mesh(mesh, soup, 1);
    const int64_t euler = samples::euler(mesh);
    const size_t faces = mesh.faces().size();
    const double volume = samples::volume(mesh);
    const samples::Woken woken(mesh);
    plc::refine(mesh, samples::kSerial);
    REQUIRE(plc::broken_invariant(mesh) == "");
    CHECK(mesh.faces().size() == 3 * faces);
    CHECK(samples::euler(mesh) == euler);
    CHECK(samples::meeting_count(mesh) == 0);
    CHECK(samples::volume(mesh) > 0.3 * volume);  // of a tetrahedron a third is left
    CHECK(samples::volume(mesh) < 1.5 * volume);
    CHECK(mesh.delta == Approx(1 / plc::kRefinement));
    CHECK(mesh.slots() == mesh.vertex_count());
    for (uint32_t v = 0; v < mesh.slots(); ++v) CHECK(woken[v]);
  }
}

TEST_CASE("edges shrink to about 1 / sqrt 3 each time", "[refinement]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), 1);
  double before = mean_edge(mesh);
  for (int i = 0; i < 3; ++i) {
    plc::refine(mesh, samples::kSerial);
    const double after = mean_edge(mesh);
    CHECK(before / after == Approx(plc::kRefinement).epsilon(0.03));
    before = after;
  }
}

TEST_CASE("two refinements divide every edge in three: old vertices have doubled no valence",
          "[refinement]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  plc::Vector<uint32_t> before(64, 0), after(64, 0);
  for (uint32_t v = 0; v < mesh.slots(); ++v) ++before[mesh.valence(v)];
  const uint32_t old_vertices = mesh.slots();
  plc::refine(mesh, samples::kSerial);
  for (uint32_t v = 0; v < mesh.slots(); ++v) ++after[mesh.valence(v)];
  // Old ones keep theirs, new ones have 6.
  before[6] += mesh.slots() - old_vertices;
  CHECK(after == before);
}

TEST_CASE("the vertices of refinement are the centres of faces, with their mean velocity",
          "[refinement]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tetrahedron(), 1);
  for (uint32_t v = 0; v < 4; ++v) mesh.velocity.set(v, mesh.at(v) * 3);
  plc::refine(mesh, samples::kSerial);
  int centres = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    CHECK(plc::length(mesh.velocity.at(v) - mesh.at(v) * 3) < 1e-5F);
    if (plc::length(mesh.at(v)) > 1) continue;
    ++centres;
    CHECK(plc::length(mesh.at(v)) == Approx(std::sqrt(3.0) / 3));
  }
  CHECK(centres == 4);
}

TEST_CASE("ids follow a Morton curve afterwards", "[refinement]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), 0.1);
  plc::refine(mesh, samples::kSerial);
  const auto order = plc::morton_order(mesh);
  for (uint32_t v = 0; v < mesh.slots(); ++v) CHECK(order[v] == v);
}

TEST_CASE("the Morton order lists every living vertex once, neighbours in space together",
          "[refinement]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(4), 0.05);
  samples::Random random(19);
  double shuffled = 0, sorted = 0;
  plc::Vector<uint32_t> order = plc::morton_order(mesh);
  REQUIRE(order.size() == mesh.vertex_count());
  for (size_t i = 1; i < order.size(); ++i) {
    sorted += static_cast<double>(plc::length(mesh.at(order[i]) - mesh.at(order[i - 1])));
    const auto other = static_cast<uint32_t>(random.integer(0, mesh.slots() - 1));
    shuffled += static_cast<double>(plc::length(mesh.at(order[i]) - mesh.at(other)));
  }
  CHECK(sorted < shuffled / 5);
  std::sort(order.begin(), order.end());
  CHECK(std::unique(order.begin(), order.end()) == order.end());
}

TEST_CASE("faces that would meet after a refinement keep their old edges", "[refinement]") {
  // An octahedron and in it another, turned by an eighth, whose corners touch the inside of the
  // outer one's edges nearly. Inverted, those would dip below the corners.
  Soup soup = samples::octahedron();
  Soup inner = samples::flipped(samples::octahedron());
  for (size_t i = 0; i < inner.xyz.size(); i += 3) {
    const double x = inner.xyz[i], y = inner.xyz[i + 1];
    inner.xyz[i] = 0.6 * std::sqrt(0.5) * (x - y);
    inner.xyz[i + 1] = 0.6 * std::sqrt(0.5) * (x + y);
    inner.xyz[i + 2] *= 0.6;
  }
  soup.append(inner);
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  REQUIRE(samples::meeting_count(mesh) == 0);
  const auto is_corner = [&](uint32_t v) {
    const float r = plc::length(mesh.at(v));
    return std::abs(r - 1) < 1e-5F || std::abs(r - 0.6F) < 1e-5F;
  };
  plc::refine(mesh, samples::kSerial);
  REQUIRE(plc::broken_invariant(mesh) == "");
  CHECK(samples::meeting_count(mesh) == 0);
  CHECK(mesh.vertex_count() == 12 + 16);
  CHECK(samples::euler(mesh) == 4);
  int kept = 0, inverted = 0;
  samples::for_each_edge(mesh, [&](uint32_t u, uint32_t k) {
    const bool first = is_corner(u), second = is_corner(mesh.neighbor(u, k));
    kept += first && second ? 1 : 0;
    inverted += first || second ? 0 : 1;
  });
  CHECK(kept >= 4);
  CHECK(kept + inverted == 24);
}

TEST_CASE("a face stays whole where rounding would put its centre beyond another face",
          "[refinement]") {
  Mesh mesh;
  Soup soup = samples::flat_tetrahedron();
  soup.append(samples::moved(samples::octahedron(), 1000, 1000, 900));
  samples::fill_mesh(mesh, soup, 1);
  REQUIRE(samples::meeting_count(mesh) == 0);
  plc::refine(mesh, samples::kSerial);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(samples::meeting_count(mesh) == 0);
  CHECK(mesh.slots() == mesh.vertex_count());
  CHECK(mesh.vertex_count() < 4 + 4 + 14);
  CHECK(mesh.vertex_count() >= 4 + 14);
}

TEST_CASE("no face is left without an area where centres are rounded onto corners",
          "[refinement]") {
  Mesh mesh;
  Soup soup = samples::tetrahedron();
  for (double& c : soup.xyz) c = 1000 + (c + 1) * 0x1p-15;  // neighbouring floats
  samples::fill_mesh(mesh, soup, 1);
  REQUIRE(samples::meeting_count(mesh) == 0);
  plc::refine(mesh, samples::kSerial);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(mesh.vertex_count() == 4);
}

TEST_CASE("many components, long rings and gaps in the ids are refined alike", "[refinement]") {
  Soup soup = samples::sphere(1);
  soup.append(samples::moved(samples::bipyramid(45, 1), 5, 0, 0));
  soup.append(samples::moved(samples::torus(7, 5, 2, 0.5), 0, 9, 0));
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  for (uint32_t v = 0; v < 18; ++v) mesh.destroy(v);  // the first component
  REQUIRE(plc::broken_invariant(mesh) == "");
  plc::refine(mesh, samples::kSerial);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(samples::component_count(mesh) == 2);
  CHECK(samples::euler(mesh) == 2);
  CHECK(mesh.vertex_count() == 47 + 90 + 35 + 70);
}

TEST_CASE("a refinement is the same for any executor", "[refinement]") {
  Mesh one, other;
  samples::fill_mesh(one, samples::torus(40, 30, 3, 1), 1);
  samples::fill_mesh(other, samples::torus(40, 30, 3, 1), 1);
  plc::refine(one, samples::kSerial);
  plc::refine(other, fixtures::ThreadExecutor(3));
  CHECK(samples::sorted_faces(one) == samples::sorted_faces(other));
}

TEST_CASE("as many refinements as bring the density nearest", "[refinement]") {
  for (int steps = 0; steps < 40; ++steps) {
    const double finest = std::pow(plc::kRefinement, -steps);
    for (const double off : {-0.499, -0.2, 0.0, 0.2, 0.499}) {
      const double to = 3.7 * finest * std::pow(plc::kRefinement, off);
      CHECK(plc::refinements_between(3.7, to) == steps);
    }
  }
  CHECK(plc::refinements_between(1, 100) == 0);
  CHECK(plc::refinements_between(1e300, 1e-300) > 1000);  // a ratio that is infinite ends
}

TEST_CASE("a refinement asks for all its ids before it changes anything", "[refinement]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 0.5);
  const uint32_t before = mesh.slots();
  mesh.most_vertices = 3 * before - 1;
  CHECK_THROWS_AS(plc::refine(mesh, samples::kSerial), plc::TooManyVertices);
  CHECK(mesh.slots() == before);
  CHECK(mesh.delta == 0.5);
  CHECK(plc::broken_invariant(mesh) == "");
  mesh.most_vertices = 3 * before;
  plc::refine(mesh, samples::kSerial);
  CHECK(mesh.vertex_count() == 3 * before - 4);
}
