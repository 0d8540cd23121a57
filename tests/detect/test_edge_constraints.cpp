#include "engine/detect/edge_constraints.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/transform/deletion.h"
#include "tests/samples/sample_sizing.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Mesh;
using plc::Operation;

// An octahedron: edge 0-2 runs from (1,0,0) to (0,1,0), its apexes are (0,0,1) and (0,0,-1).
constexpr uint32_t kU = 0, kV = 2;

std::optional<plc::Candidate> candidate_of(const Mesh& mesh, uint32_t u, uint32_t v) {
  return plc::edge_candidate(mesh, u, mesh.ring(u).find(v));
}

Mesh octahedron(double delta) {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), delta);
  return mesh;
}

// Places u and v so that the edge has the given length along x; apexes far off along z.
void stretch(Mesh& mesh, float length, float apex) {
  mesh.place(kU, {length, 0, 0});
  mesh.place(kV, {0, 0, 0});
  mesh.place(4, {length / 2, 0, apex});
  mesh.place(5, {length / 2, 0, -apex});
}

}  // namespace

TEST_CASE("an edge within (1) and (2) asks for nothing", "[edge_constraints]") {
  Mesh mesh = octahedron(1);
  for (const float length : {1.0001F, 1.5F, 2.4999F}) {
    stretch(mesh, length, 5);
    CHECK_FALSE(candidate_of(mesh, kU, kV).has_value());
  }
}

TEST_CASE("an edge of exactly delta is too short, one of exactly 2.5 delta too long",
          "[edge_constraints]") {
  for (const double delta : {1.0, 0.5, 2.0}) {
    Mesh mesh = octahedron(delta);
    const auto d = static_cast<float>(delta);
    stretch(mesh, d, 5 * d);
    const auto shortest = candidate_of(mesh, kU, kV);
    REQUIRE(shortest.has_value());
    CHECK(shortest->operation == Operation::kDeletion);
    CHECK(shortest->key == d * d);
    stretch(mesh, 2.5F * d, 5 * d);
    const auto longest = candidate_of(mesh, kU, kV);
    REQUIRE(longest.has_value());
    CHECK(longest->operation == Operation::kCreation);
    CHECK(longest->key == -6.25F * d * d);
    stretch(mesh, std::nextafter(2.5F * d, 0.0F), 5 * d);
    CHECK_FALSE(candidate_of(mesh, kU, kV).has_value());
    stretch(mesh, std::nextafter(d, 9.0F), 5 * d);
    CHECK_FALSE(candidate_of(mesh, kU, kV).has_value());
  }
}

TEST_CASE("a candidate carries its edge with the apexes", "[edge_constraints]") {
  Mesh mesh = octahedron(1);
  stretch(mesh, 0.5F, 5);
  const auto candidate = candidate_of(mesh, kU, kV);
  const plc::Edge e = plc::edge_between(mesh, kU, kV);
  CHECK(candidate->edge.u == kU);
  CHECK(candidate->edge.v == kV);
  CHECK(candidate->edge.a == e.a);
  CHECK(candidate->edge.b == e.b);
}

TEST_CASE("ends that coincide ask for a deletion", "[edge_constraints]") {
  Mesh mesh = octahedron(1);
  stretch(mesh, 0, 5);
  REQUIRE(candidate_of(mesh, kU, kV).has_value());
  CHECK(candidate_of(mesh, kU, kV)->operation == Operation::kDeletion);
  CHECK(candidate_of(mesh, kU, kV)->key == 0);
}

TEST_CASE("a short edge of a narrow tube asks for a cut around it", "[edge_constraints]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tube(3, 6, 0.4), 1);
  // Corners of the third cross-section.
  const auto candidate = candidate_of(mesh, 6, 7);
  REQUIRE(candidate.has_value());
  CHECK(candidate->operation == Operation::kAnnular);
  CHECK(candidate->edge.a == 8);
  CHECK(candidate->edge.u == 6);
  CHECK(candidate->edge.v == 7);
}

TEST_CASE("a tube that the image has is not cut", "[edge_constraints]") {
  const samples::FullImage object(true), other(false);
  Mesh mesh;
  samples::fill_mesh(mesh, samples::tube(3, 6, 0.4), 1);
  mesh.sizing = &object.sizing;
  CHECK_FALSE(candidate_of(mesh, 6, 7).has_value());
  mesh.sizing = &other.sizing;
  REQUIRE(candidate_of(mesh, 6, 7).has_value());
  CHECK(candidate_of(mesh, 6, 7)->operation == Operation::kAnnular);
}

TEST_CASE("limits of an edge are those of the sizes at its ends", "[edge_constraints]") {
  Mesh mesh = octahedron(1);
  stretch(mesh, 1.4F, 2);
  CHECK_FALSE(candidate_of(mesh, kU, kV).has_value());
  mesh.position[kU].w = 1;
  REQUIRE(candidate_of(mesh, kU, kV).has_value());
  CHECK(candidate_of(mesh, kU, kV)->operation == Operation::kDeletion);
  mesh.position[kU].w = mesh.position[kV].w = -0.5F;
  REQUIRE(candidate_of(mesh, kU, kV).has_value());
  CHECK(candidate_of(mesh, kU, kV)->operation == Operation::kCreation);
}

TEST_CASE("of several cycles the shortest is cut, of equal ones that of the smallest id",
          "[edge_constraints]") {
  // Both apexes of a bipyramid are neighbours after an inversion: u-v with n - 2 other cycles.
  Mesh mesh;
  samples::fill_mesh(mesh, samples::bipyramid(6, 0.3), 1);
  // 6 and 7 joined in place of 0-1.
  const plc::Edge e = plc::edge_between(mesh, 0, 1);
  mesh.remove(0, 1);
  mesh.remove(1, 0);
  mesh.insert_after(e.a, 1, e.b);
  mesh.insert_after(e.b, 0, e.a);
  REQUIRE(plc::broken_invariant(mesh) == "");
  REQUIRE(plc::common_neighbors(mesh, 6, 7).size() == 6);
  auto candidate = candidate_of(mesh, 6, 7);
  REQUIRE(candidate.has_value());
  CHECK(candidate->operation == Operation::kAnnular);
  mesh.place(4, mesh.at(4) * 0.5F);
  CHECK(candidate_of(mesh, 6, 7)->edge.a == 4);
  for (uint32_t o = 2; o < 6; ++o) mesh.place(o, {0.5F, 0, 0});
  CHECK(candidate_of(mesh, 6, 7)->edge.a == 2);
  // The apexes of the edge are faces with it, not cycles, however near.
  mesh.place(0, {0.01F, 0, 0});
  mesh.place(1, {0.01F, 0, 0});
  CHECK(candidate_of(mesh, 6, 7)->edge.a == 2);
}

TEST_CASE("a long edge with an apex near its middle is inverted, else split",
          "[edge_constraints]") {
  Mesh mesh = octahedron(1);
  stretch(mesh, 2.6F, 0.9F);
  auto candidate = candidate_of(mesh, kU, kV);
  REQUIRE(candidate.has_value());
  CHECK(candidate->operation == Operation::kInversion);
  CHECK(candidate->key < 0);
  stretch(mesh, 2.6F, 1.0F);
  CHECK(candidate_of(mesh, kU, kV)->operation == Operation::kInversion);
  stretch(mesh, 2.6F, 1.01F);
  CHECK(candidate_of(mesh, kU, kV)->operation == Operation::kCreation);
  // One near apex is enough, unless the inverted edge is no shorter.
  stretch(mesh, 2.6F, 0.9F);
  mesh.place(5, {1.3F, 0, -1.6F});
  CHECK(candidate_of(mesh, kU, kV)->operation == Operation::kInversion);
  mesh.place(5, {1.3F, 0, -1.71F});
  CHECK(candidate_of(mesh, kU, kV)->operation == Operation::kCreation);
}

TEST_CASE("a long edge that may not be inverted is split", "[edge_constraints]") {
  // Ends of valence 3: two of the three corners of a bipyramid's apex.
  Mesh mesh;
  samples::fill_mesh(mesh, samples::bipyramid(3, 1), 1);
  mesh.place(4, {1.4F, 0, 0.3F});
  mesh.place(0, {-1.4F, 0, 0.3F});
  mesh.place(1, {0, 0.5F, 0});
  mesh.place(2, {0, -0.5F, 0});
  const auto candidate = candidate_of(mesh, 0, 4);
  REQUIRE(candidate.has_value());
  CHECK(candidate->operation == Operation::kCreation);
}
