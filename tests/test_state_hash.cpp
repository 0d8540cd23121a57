#include "engine/state_hash.h"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>

#include "tests/sample_surfaces.h"

namespace {

using plc::Mesh;

// FNV-1a, byte by byte, of what the header says.
uint64_t fnv(const std::vector<uint8_t>& bytes) {
  uint64_t hash = 14695981039346656037ULL;
  for (const uint8_t byte : bytes) hash = (hash ^ byte) * 1099511628211ULL;
  return hash;
}

template <typename T>
void append(std::vector<uint8_t>& bytes, T value) {
  for (size_t i = 0; i < sizeof(T); ++i) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

std::vector<uint8_t> serialised(const Mesh& mesh) {
  std::vector<uint8_t> bytes;
  append(bytes, uint64_t{mesh.vertex_count()});
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    for (const float c : {mesh.at(v).x, mesh.at(v).y, mesh.at(v).z}) {
      append(bytes, std::bit_cast<uint32_t>(c));
    }
  }
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    std::vector<uint32_t> ring;
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

TEST_CASE("the FNV-1a of the test has the published values", "[state_hash]") {
  CHECK(fnv({}) == 0xCBF29CE484222325ULL);
  CHECK(fnv({'a'}) == 0xAF63DC4C8601EC8CULL);
  CHECK(fnv({'f', 'o', 'o', 'b', 'a', 'r'}) == 0x85944171F73967E8ULL);
}

TEST_CASE("the hash is the FNV-1a of count, positions and rings", "[state_hash]") {
  for (const samples::Soup& soup : {samples::tetrahedron(), samples::sphere(2),
                                    samples::bipyramid(40, 1), samples::torus(9, 5, 3, 1)}) {
    Mesh mesh;
    samples::fill_mesh(mesh, soup, 1);
    CHECK(plc::state_hash(mesh) == fnv(serialised(mesh)));
  }
  CHECK(plc::state_hash(Mesh()) == fnv(std::vector<uint8_t>(8, 0)));
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
  std::vector<uint32_t> order;
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
