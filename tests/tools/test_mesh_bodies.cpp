#include "tools/mesh/mesh_bodies.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/samples/sample_meshes.h"

namespace {

using plc::tools::Bodies;
using plc::tools::bodies_of;
using plc::tools::part_of;
using plc::tools::TriangleMesh;

void add(TriangleMesh& mesh, const samples::Soup& soup) {
  const auto base = static_cast<uint32_t>(mesh.xyz.size() / 3);
  mesh.xyz.insert(mesh.xyz.end(), soup.xyz.begin(), soup.xyz.end());
  for (const auto v : soup.abc) mesh.abc.push_back(base + static_cast<uint32_t>(v));
}

samples::Soup ball(double x, double radius) {
  return samples::moved(samples::sphere(2), x, 0, 0, radius);
}

double volume_of(double radius) {  // of the ball of triangles, not of the round one
  TriangleMesh mesh;
  add(mesh, ball(0, radius));
  return bodies_of(mesh).volumes[0];
}

// A shell with a core in its cavity, which is hollow itself, beside it a small ball.
TriangleMesh nested() {
  TriangleMesh mesh;
  add(mesh, samples::flipped(ball(0, 8)));  // the cavity of the shell
  add(mesh, ball(0, 10));
  add(mesh, samples::flipped(ball(0.5, 2)));
  add(mesh, ball(0, 6));
  add(mesh, ball(30, 1));
  return mesh;
}

}  // namespace

TEST_CASE("Cavities belong to the body around them, bodies in cavities to themselves",
          "[mesh_bodies]") {
  const Bodies bodies = bodies_of(nested());
  REQUIRE(bodies.volumes.size() == 3);
  CHECK(bodies.volumes[0] == Approx(volume_of(10) - volume_of(8)));
  CHECK(bodies.volumes[1] == Approx(volume_of(6) - volume_of(2)));
  CHECK(bodies.volumes[2] == Approx(volume_of(1)));
  const size_t each = bodies.of_vertex.size() / 5;
  const uint32_t expected[] = {0, 0, 1, 1, 2};
  for (size_t v = 0; v < bodies.of_vertex.size(); ++v) {
    REQUIRE(bodies.of_vertex[v] == expected[v / each]);
  }
}

TEST_CASE("Rays through vertices and edges count once", "[mesh_bodies]") {
  // Grids of cubes in a cube: every ray along an axis runs through vertices and edges of others.
  TriangleMesh mesh;
  add(mesh, samples::moved(samples::cube(), -2, -2, -2, 20));
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int z = 0; z < 3; ++z) {
        add(mesh, samples::flipped(samples::moved(samples::cube(), 2 * x, 2 * y, 2 * z)));
      }
    }
  }
  const Bodies bodies = bodies_of(mesh);
  REQUIRE(bodies.volumes.size() == 1);
  CHECK(bodies.volumes[0] == Approx(8000 - 27));
}

TEST_CASE("A part has its bodies with their normals and values, in the old order",
          "[mesh_bodies]") {
  TriangleMesh mesh = nested();
  mesh.space = "RAS";
  const size_t vertices = mesh.xyz.size() / 3;
  for (const double x : mesh.xyz) mesh.normals.push_back(static_cast<float>(-x));
  plc::tools::Scalars ids{"Ids", {}};
  for (size_t v = 0; v < vertices; ++v) ids.values.push_back(static_cast<float>(v));
  mesh.scalars = {ids};
  const Bodies bodies = bodies_of(mesh);
  const TriangleMesh part = part_of(mesh, bodies, {0, 1, 0});
  CHECK(part.space == "RAS");
  REQUIRE(part.xyz.size() / 3 == 2 * vertices / 5);
  REQUIRE(part.abc.size() == 2 * mesh.abc.size() / 5);
  for (size_t v = 0; v < part.xyz.size() / 3; ++v) {
    const auto old = static_cast<size_t>(part.scalars[0].values[v]);
    REQUIRE(bodies.of_vertex[old] == 1);
    for (size_t k = 0; k < 3; ++k) {
      REQUIRE(part.xyz[3 * v + k] == mesh.xyz[3 * old + k]);
      REQUIRE(part.normals[3 * v + k] == mesh.normals[3 * old + k]);
    }
  }
  CHECK(std::is_sorted(part.scalars[0].values.begin(), part.scalars[0].values.end()));
  CHECK(bodies_of(part).volumes[0] == Approx(bodies.volumes[1]));
}

TEST_CASE("Vertices of no face are of no body", "[mesh_bodies]") {
  TriangleMesh mesh;
  mesh.xyz = {5, 5, 5};
  add(mesh, samples::cube());
  CHECK(bodies_of(mesh).of_vertex[0] == Bodies::kNone);
  CHECK(part_of(mesh, bodies_of(mesh), {1}).xyz.size() == mesh.xyz.size() - 3);
  CHECK(bodies_of({}).volumes.empty());
}
