#include "engine/start/half_edges.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "engine/base/mesh_arrays.h"
#include "engine/measure/mesh_check.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::HalfEdges;
using samples::Soup;

HalfEdges half_edges_of(const Soup& soup) {
  return {samples::buffer_of<uint32_t>(soup.abc), soup.xyz.size() / 3, samples::kSerial};
}

// What of the soup is left, where every corner is: broken where it is no closed manifold.
plc::MeshCheck checked(const Soup& soup, const HalfEdges& mesh) {
  std::vector<uint32_t> abc;
  for (size_t f = 0; f < mesh.face_slots(); ++f) {
    if (mesh.face_alive(f)) abc.insert(abc.end(), mesh.face(f), mesh.face(f) + 3);
  }
  plc::MeshCheck check;
  REQUIRE(plc::check_mesh(plc::arrays_of(soup.xyz, abc), samples::kSerial, check).ok());
  return check;
}

// Every half-edge has its twin, and every vertex leads to its ring.
void check_links(const HalfEdges& mesh) {
  for (size_t f = 0; f < mesh.face_slots(); ++f) {
    if (!mesh.face_alive(f)) continue;
    for (auto h = static_cast<uint32_t>(3 * f); h < 3 * f + 3; ++h) {
      REQUIRE(mesh.twin(mesh.twin(h)) == h);
      CHECK(mesh.from(mesh.twin(h)) == mesh.to(h));
      CHECK(mesh.to(mesh.twin(h)) == mesh.from(h));
      CHECK(mesh.alive(mesh.from(h)));
    }
  }
  for (uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
    if (mesh.alive(v)) CHECK(mesh.from(mesh.out(v)) == v);
  }
}

void check_same(const HalfEdges& mesh, const HalfEdges& other) {
  for (uint32_t h = 0; h < 3 * other.face_slots(); ++h) {
    REQUIRE(mesh.from(h) == other.from(h));
    REQUIRE(mesh.twin(h) == other.twin(h));
  }
  for (uint32_t v = 0; v < other.vertex_slots(); ++v) REQUIRE(mesh.out(v) == other.out(v));
}

}  // namespace

TEST_CASE("rings are counter-clockwise seen from outside", "[half_edges]") {
  const Soup soup = samples::octahedron();
  const HalfEdges mesh = half_edges_of(soup);
  check_links(mesh);
  for (uint32_t v = 0; v < mesh.vertex_slots(); ++v) {
    std::vector<uint32_t> ring;
    mesh.visit_ring(v, [&](uint32_t h) { ring.push_back(mesh.to(h)); });
    REQUIRE(ring.size() == 4);
    for (size_t k = 0; k < 4; ++k) {
      std::array<uint32_t, 3> face{v, ring[k], ring[(k + 1) % 4]};
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      bool there = false;
      for (size_t f = 0; f < soup.abc.size(); f += 3) {
        std::array<uint32_t, 3> other{soup.abc[f], soup.abc[f + 1], soup.abc[f + 2]};
        std::rotate(other.begin(), std::min_element(other.begin(), other.end()), other.end());
        there = there || other == face;
      }
      CHECK(there);
    }
  }
}

TEST_CASE("a contraction takes two faces, and all is as before when it is undone", "[half_edges]") {
  const Soup soup = samples::torus(12, 9, 2, 0.7);
  const HalfEdges before = half_edges_of(soup);
  for (uint32_t h = 0; h < 3 * before.face_slots(); h += 7) {
    HalfEdges mesh = before;
    const uint32_t v = mesh.from(h), w = mesh.to(h);
    const HalfEdges::Contraction done = mesh.contract(h);
    check_links(mesh);
    CHECK(mesh.alive(v));
    CHECK(!mesh.alive(w));
    const plc::MeshCheck check = checked(soup, mesh);
    CHECK(check.closed == 1);
    CHECK(check.oriented == 1);
    CHECK(check.measures.euler == 0);
    CHECK(check.measures.faces == static_cast<int64_t>(before.face_slots()) - 2);
    mesh.undo(done);
    check_same(mesh, before);
  }
}
