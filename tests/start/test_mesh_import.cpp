#include "engine/start/mesh_import.h"

#include <catch2/catch.hpp>
#include <limits>
#include <string>

#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_woken.h"

namespace {

using plc::Mesh;
using samples::Soup;

plc::Status import(const Soup& m, Mesh& mesh) {
  return plc::import_mesh(m.arrays(), samples::kSerial, mesh);
}

// What is said about a mesh that must be refused, and must leave what was there.
std::string complaint(const Soup& m) {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::octahedron(), 0.25);
  const plc::Status status = import(m, mesh);
  CHECK(status.code() == plc::ErrorCode::kInvalidData);
  CHECK(mesh.vertex_count() == 6);
  CHECK(mesh.delta == 0.25);
  CHECK(status.message().find('\n') == std::string::npos);
  return status.message();
}

// The faces of a soup, each from its smallest corner, sorted.
std::vector<samples::FaceIds> sorted_faces(const Soup& m) {
  std::vector<samples::FaceIds> faces;
  for (size_t i = 0; i < m.abc.size(); i += 3) {
    samples::FaceIds f{m.abc[i], m.abc[i + 1], m.abc[i + 2]};
    std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
    faces.push_back(f);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

Soup cavity(bool wall_inward) {
  Soup m = samples::moved(samples::sphere(3), 0, 0, 0, 4);
  const Soup wall = samples::moved(samples::sphere(2), 0.5, 0, 0, 2);
  m.append(wall_inward ? samples::flipped(wall) : wall);
  return m;
}

}  // namespace

TEST_CASE("closed surfaces arrive face by face", "[mesh_import]") {
  Soup pair = samples::cube();
  pair.append(samples::moved(samples::sphere(2), 5, 5, 5));
  for (const Soup& m : {samples::tetrahedron(), samples::cube(), samples::torus(24, 12, 2, 0.7),
                        cavity(true), pair, samples::bipyramid(40, 3)}) {
    Mesh mesh;
    mesh.delta = 0.75;
    const samples::Woken woken(mesh);
    REQUIRE(import(m, mesh).message() == "");
    CHECK(plc::broken_invariant(mesh) == "");
    CHECK(mesh.slots() == m.vertex_count());
    CHECK(samples::sorted_faces(mesh) == sorted_faces(m));
    CHECK(mesh.delta == 0.75);
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      CHECK(mesh.at(v).x == static_cast<float>(m.xyz[3 * v]));
      CHECK(mesh.at(v).z == static_cast<float>(m.xyz[3 * v + 2]));
      CHECK(woken[v]);
    }
  }
}

TEST_CASE("an imported mesh takes the place of what was there", "[mesh_import]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::torus(20, 10, 3, 1), 1);
  mesh.destroy(3);
  REQUIRE(import(samples::cube(), mesh).ok());
  CHECK(mesh.slots() == 8);
  CHECK(plc::broken_invariant(mesh) == "");
}

TEST_CASE("vertices without a face are dropped", "[mesh_import]") {
  Soup m;
  m.vertex(9, 9, 9);
  m.append(samples::cube());
  m.vertex(1e60, 0, 0);
  Mesh mesh;
  REQUIRE(import(m, mesh).message() == "");
  CHECK(mesh.slots() == 8);
  CHECK(samples::sorted_faces(mesh) == sorted_faces(samples::cube()));
}

TEST_CASE("a mesh without faces is refused", "[mesh_import]") {
  CHECK(complaint(Soup{}) == "mesh: no faces");
  Mesh mesh;
  CHECK(plc::import_mesh({nullptr, 3, nullptr, 0}, samples::kSerial, mesh).code() ==
        plc::ErrorCode::kInvalidArgument);
  CHECK(plc::import_mesh({nullptr, size_t{1} << 40U, nullptr, 0}, samples::kSerial, mesh).code() ==
        plc::ErrorCode::kInvalidArgument);
}

TEST_CASE("values and indices that cannot be are refused by name", "[mesh_import]") {
  Soup m = samples::cube();
  m.xyz[7] = std::numeric_limits<double>::quiet_NaN();
  CHECK(complaint(m) == "mesh: vertex 2: y is nan, expected a finite number");
  m = samples::cube();
  m.abc[17] = 8;
  CHECK(complaint(m) == "mesh: face 5: corner 2 is vertex 8, expected an index below 8");
}

TEST_CASE("what lies where floats no longer tell voxels apart is refused", "[mesh_import]") {
  CHECK(complaint(samples::moved(samples::cube(), 0, 3e7, 0)) ==
        "mesh: vertex 0: y is 3e+07 in mesh space, expected -16777216 to 16777216");
}

TEST_CASE("an open mesh is refused where its border is", "[mesh_import]") {
  Soup m = samples::cube();
  m.abc.resize(m.abc.size() - 3);  // face 1, 7, 5
  CHECK(complaint(m) ==
        "mesh: open: 3 border edges, the first between vertices 1 and 5 at (1, 0, 0.5)");
}

TEST_CASE("edges of many faces are refused by name", "[mesh_import]") {
  // Two tetrahedra with the common edge 0-1.
  Soup m;
  m.xyz = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0};
  m.abc = {0, 3, 2, 0, 2, 1, 2, 3, 1, 3, 0, 1, 0, 5, 4, 0, 4, 1, 4, 5, 1, 5, 0, 1};
  CHECK(complaint(m) ==
        "mesh: not manifold: 1 edges of more than two faces, the first between "
        "vertices 0 and 1 at (0, 0, 0.5)");
}

TEST_CASE("sheets that touch in a vertex are refused by name", "[mesh_import]") {
  Soup m = samples::cube();
  m.append(samples::moved(samples::cube(), 1, 1, 1));
  // Vertex 8 of the second cube becomes vertex 7 of the first.
  for (uint32_t& v : m.abc) v = v == 8 ? 7 : v;
  CHECK(complaint(m) ==
        "mesh: not manifold: 1 vertices where sheets touch, the first vertex 7 at "
        "(1, 1, 1)");
}

TEST_CASE("a face turned over is refused by one of its edges", "[mesh_import]") {
  Soup m = samples::cube();
  std::swap(m.abc[0], m.abc[1]);  // face 0, 2, 3
  CHECK(complaint(m) ==
        "mesh: inconsistently oriented: 3 edges that both faces run in the same "
        "direction, the first between vertices 0 and 2 at (0, 0.5, 0)");
}

TEST_CASE("degenerate faces are refused by name", "[mesh_import]") {
  Soup m = samples::cube();
  m.face(4, 7, 7);
  CHECK(complaint(m).find("mesh: degenerate: a face repeats a vertex: face 12 with vertices 4, 7, "
                          "7 at (0.666667, 0.666667, 1)") == 0);
  // Vertex 4 on the edge 0-1; the flat face 0-1-4 closes the gap.
  m = Soup{};
  m.xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0.5, 0, 0};
  m.abc = {0, 2, 4, 4, 2, 1, 0, 4, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  CHECK(complaint(m) ==
        "mesh: degenerate: 1 faces of zero area, the first face 2 with vertices 0, "
        "4, 1 at (0.5, 0, 0)");
}

TEST_CASE("a self-intersecting mesh is refused with the first pair of faces", "[mesh_import]") {
  Soup m = samples::cube();
  m.append(samples::moved(samples::cube(), 0.5, 0.25, 0.125));
  CHECK_THAT(complaint(m), Catch::Matchers::StartsWith("mesh: self-intersecting: ") &&
                               Catch::Matchers::Contains(" pairs of faces, the first ") &&
                               Catch::Matchers::Contains(" at ("));
}

TEST_CASE("a component inside out is refused by its first face", "[mesh_import]") {
  CHECK(complaint(samples::flipped(samples::cube())) ==
        "mesh: wrongly oriented: 1 of 1 components, the first with face 0 at (0.333333, 0.666667, "
        "0), whose faces must be turned outward");
  CHECK_THAT(complaint(cavity(false)),
             Catch::Matchers::Contains("wrongly oriented: 1 of 2 components, the first with face "
                                       "512 at (") &&
                 Catch::Matchers::EndsWith("the wall of a cavity, whose faces must be turned "
                                           "inward"));
}

TEST_CASE("what meets only after rounding to floats is refused for it", "[mesh_import]") {
  Soup m = samples::moved(samples::cube(), 1000, 0, 0);
  m.append(samples::moved(samples::cube(), 1001 + 1e-6, 0.25, 0.25));
  CHECK_THAT(complaint(m), Catch::Matchers::StartsWith(
                               "mesh: after rounding to single precision: self-intersecting: "));
  Soup near = samples::moved(samples::cube(), 1000, 0, 0);
  near.append(samples::moved(samples::cube(), 1001 + 1e-3, 0.25, 0.25));
  Mesh mesh;
  CHECK(import(near, mesh).message() == "");
  // A surface that becomes a point.
  Soup flat = samples::octahedron();
  for (double& x : flat.xyz) x *= 0.9e-3;  // half a step of floats at 20000 is 0.98e-3
  CHECK_THAT(
      complaint(samples::moved(flat, 20000, 20000, 20000)),
      Catch::Matchers::StartsWith("mesh: after rounding to single precision: degenerate: 8 "));
}

TEST_CASE("a vertex with more edges than a ring holds is refused", "[mesh_import]") {
  // Cones over a regular polygon: flat sides, exact predicates.
  const Soup m = samples::bipyramid(65536, 3);
  CHECK(complaint(m) == "mesh: vertex 65536 has 65536 faces, at most 65535 are possible");
}
