#include "engine/mesh/state_hash.h"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <functional>
#include <string>

#include "pyramid/memory.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Mesh;

uint64_t fnv(const plc::Vector<uint8_t>& bytes) {
  plc::Fnv hash;
  hash.add_all(bytes);
  return hash.value();
}

template <typename T>
void append(plc::Vector<uint8_t>& bytes, T value) {
  for (size_t i = 0; i < sizeof(T); ++i) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

plc::Vector<uint8_t> serialised(const Mesh& mesh) {
  plc::Vector<uint8_t> bytes;
  append(bytes, uint64_t{mesh.vertex_count()});
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    for (const float c : {mesh.at(v).x, mesh.at(v).y, mesh.at(v).z}) {
      append(bytes, std::bit_cast<uint32_t>(c));
    }
  }
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    plc::Vector<uint32_t> ring;
    for (uint32_t k = 0; k < mesh.valence(v); ++k) ring.push_back(mesh.neighbor(v, k));
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    append(bytes, mesh.valence(v));
    for (const uint32_t w : ring) append(bytes, w);
  }
  return bytes;
}

Mesh filled() {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::torus(9, 5, 3, 1), 1);
  return mesh;
}

}  // namespace

TEST_CASE("the hash is the FNV-1a of count, positions and rings", "[state_hash]") {
  for (const samples::Soup& soup : {samples::tetrahedron(), samples::sphere(2),
                                    samples::bipyramid(40, 1), samples::torus(9, 5, 3, 1)}) {
    Mesh mesh;
    samples::fill_mesh(mesh, soup, 1);
    CHECK(plc::state_hash(mesh) == fnv(serialised(mesh)));
  }
  CHECK(plc::state_hash(Mesh()) == fnv(plc::Vector<uint8_t>(8, 0)));
}

TEST_CASE("where a ring starts does not matter", "[state_hash]") {
  Mesh mesh = filled();
  const uint64_t before = plc::state_hash(mesh);
  plc::Neighbors ring = mesh.ring(7);
  std::rotate(ring.data(), ring.data() + 2, ring.data() + ring.size());
  mesh.set_ring(7, ring);
  CHECK(plc::state_hash(mesh) == before);
}

TEST_CASE("a bit of a position, a ring's order, a swap of ids: each changes the hash",
          "[state_hash]") {
  const uint64_t before = plc::state_hash(filled());
  Mesh moved = filled();
  moved.place(3, {std::nextafter(moved.at(3).x, 9.0F), moved.at(3).y, moved.at(3).z});
  CHECK(plc::state_hash(moved) != before);
  Mesh turned = filled();
  plc::Neighbors ring = turned.ring(7);
  std::reverse(ring.data(), ring.data() + ring.size());
  turned.set_ring(7, ring);
  CHECK(plc::state_hash(turned) != before);
  Mesh renumbered = filled();
  plc::Vector<uint32_t> order;
  for (uint32_t v = 0; v < renumbered.slots(); ++v) order.push_back(v);
  std::swap(order[4], order[20]);
  renumbered.renumber(order);
  CHECK(plc::state_hash(renumbered) != before);
}

TEST_CASE("velocities and delta are not part of it", "[state_hash]") {
  Mesh mesh = filled();
  const uint64_t before = plc::state_hash(mesh);
  mesh.velocity.set(3, {1, 2, 3});
  mesh.delta = 5;
  CHECK(plc::state_hash(mesh) == before);
}

TEST_CASE("a change of one stream changes the hash of its part and of no other", "[state_hash]") {
  const std::vector<plc::PartHash> before = plc::part_hashes(filled());
  const auto changed = [&](const std::function<void(Mesh&)>& change) {
    Mesh mesh = filled();
    change(mesh);
    const std::vector<plc::PartHash> after = plc::part_hashes(mesh);
    REQUIRE(after.size() == before.size());
    std::string parts;
    for (size_t p = 0; p < after.size(); ++p) {
      CHECK(after[p].part == before[p].part);
      if (after[p] != before[p]) parts.append(after[p].part).append(";");
    }
    return parts;
  };
  CHECK(changed([](Mesh&) {}).empty());
  CHECK(changed([](Mesh& m) { m.delta = 0.5; }) == "counts and delta;");
  CHECK(changed([](Mesh& m) { m.position[7].z = 3; }) == "position;");
  CHECK(changed([](Mesh& m) { m.velocity.x[7] = -0.0F; }) == "velocity;");
  CHECK(changed([](Mesh& m) { m.normal.y[7] = 0.5F; }) == "normal;");
  CHECK(changed([](Mesh& m) { m.displacement.z[7] = 0.5F; }) == "displacement;");
  CHECK(changed([](Mesh& m) { m.path[7] = 0.5F; }) == "path;");
  CHECK(changed([](Mesh& m) { m.turns[7] ^= 1U; }) == "turns;");
  CHECK(changed([](Mesh& m) { m.cut_id[7] ^= 1U; }) == "cut id;");
  CHECK(changed([](Mesh& m) { m.cut_iteration[7] ^= 1U; }) == "cut iteration;");
}

TEST_CASE("where a ring starts, and which id is taken next, are parts of the state",
          "[state_hash]") {
  Mesh mesh = filled();
  const std::vector<plc::PartHash> before = plc::part_hashes(mesh);
  plc::Neighbors ring = mesh.ring(7);
  std::rotate(ring.data(), ring.data() + 2, ring.data() + ring.size());
  mesh.set_ring(7, ring);
  const std::vector<plc::PartHash> turned = plc::part_hashes(mesh);
  CHECK(turned[1] != before[1]);
  CHECK(turned[1].part == "rings");

  Mesh one = filled(), other = filled();
  for (const uint32_t v : {3U, 9U}) one.destroy(v);
  for (const uint32_t v : {9U, 3U}) other.destroy(v);
  const std::vector<plc::PartHash> first = plc::part_hashes(one), second = plc::part_hashes(other);
  for (size_t p = 0; p < first.size(); ++p) {
    CHECK((first[p] == second[p]) == (first[p].part != "free ids"));
  }
}
