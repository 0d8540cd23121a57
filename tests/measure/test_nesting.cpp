#include "engine/measure/nesting.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <vector>

#include "pyramid/memory.h"
#include "tests/samples/sample_meshes.h"

namespace {

using samples::Soup;

plc::Vector<plc::ComponentSide> sides(const Soup& m) {
  const plc::SerialExecutor serial;
  const plc::MeshTopology topology =
      plc::mesh_topology(m.abc.data(), m.face_count(), m.vertex_count(), serial);
  plc::Vector<uint32_t> ids(m.face_count());
  std::iota(ids.begin(), ids.end(), 0U);
  plc::FaceTree tree;
  tree.build(m.xyz.data(), m.abc.data(), ids.data(), ids.size(), serial);
  return plc::component_sides(m.arrays(), topology,
                              plc::component_measures(m.arrays(), topology, serial), tree, serial);
}

}  // namespace

TEST_CASE("shells alternate between outward and inward with their depth", "[nesting]") {
  Soup m;
  for (int depth = 0; depth < 7; ++depth) {
    const Soup shell = samples::moved(samples::sphere(2), 0.01 * depth, 0, 0, 7 - depth);
    m.append(depth % 2 == 1 ? samples::flipped(shell) : shell);
  }
  const auto result = sides(m);
  REQUIRE(result.size() == 7);
  for (size_t depth = 0; depth < 7; ++depth) {
    CHECK(result[depth].nested == (depth % 2 == 1));
    CHECK_FALSE(result[depth].wrong);
  }
}

TEST_CASE("components beside each other are not nested, whatever lies along the rays",
          "[nesting]") {
  Soup m;
  for (int i = 0; i < 6; ++i) m.append(samples::moved(samples::cube(), 0, 0, 2 * i));
  for (const plc::ComponentSide& side : sides(m)) {
    CHECK_FALSE(side.nested);
    CHECK_FALSE(side.wrong);
  }
}

TEST_CASE("rays through vertices and edges do not decide", "[nesting]") {
  // A small octahedron under an apex of a large one: the apex lies where the first ray from the
  // small one's largest face passes.
  Soup m = samples::moved(samples::octahedron(), 0, 0, 0, 1.0 / 1024);
  // The first of its faces is the largest: all are the same. Its centre is at a third of 1/1024.
  const double c = 1.0 / 1024 / 3;
  Soup large = samples::moved(samples::octahedron(), 0, 0, 0, 4);
  large.xyz[12] = c + 0.012345678 * (4 - c);
  large.xyz[13] = c + 0.0345678912 * (4 - c);
  m.append(large);
  const auto result = sides(m);
  CHECK(result[0].nested);
  CHECK(result[0].wrong);
  CHECK_FALSE(result[1].nested);
}
