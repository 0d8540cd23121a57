// Meshes of the engine made from samples, and what the tests ask of them.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/initial_surface.h"
#include "engine/mesh.h"
#include "engine/mesh_invariants.h"
#include "engine/self_meeting.h"
#include "pyramid/executor.h"
#include "tests/sample_meshes.h"
#include "tests/sample_rings.h"

namespace samples {

inline const plc::SerialExecutor kSerial;

// Vertices keep their ids; every vertex of the soup has a face.
inline void fill_mesh(plc::Mesh& mesh, const Soup& soup, double delta) {
  mesh.clear();
  const Rings rings = rings_of(soup);
  for (const plc::Packed& p : rings.positions) mesh.create({p.x, p.y, p.z}, {});
  for (uint32_t v = 0; v < rings.slots(); ++v) {
    plc::Neighbors ring;
    for (uint32_t k = 0; k < rings.valence[v]; ++k) ring.push_back(rings.view().slot(v, k));
    mesh.set_ring(v, ring);
  }
  mesh.delta = delta;
}

// V - E + F of a closed triangulated surface: 2 E = 3 F = the sum of the valences.
inline int64_t euler(const plc::Mesh& mesh) {
  int64_t ends = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) ends += mesh.valence(v);
  return mesh.vertex_count() - ends / 6;
}

inline int64_t component_count(const plc::Mesh& mesh) {
  std::vector<uint8_t> seen(mesh.slots(), 0);
  int64_t count = 0;
  for (uint32_t start = 0; start < mesh.slots(); ++start) {
    if (!mesh.alive(start) || seen[start] != 0) continue;
    ++count;
    std::vector<uint32_t> open{start};
    seen[start] = 1;
    while (!open.empty()) {
      const uint32_t v = open.back();
      open.pop_back();
      for (uint32_t k = 0; k < mesh.valence(v); ++k) {
        const uint32_t w = mesh.neighbor(v, k);
        if (seen[w] == 0) open.push_back(w);
        seen[w] = 1;
      }
    }
  }
  return count;
}

inline double volume(const plc::Mesh& mesh) {
  const std::vector<uint32_t> abc = mesh.faces();
  const auto coordinates = [&](uint32_t v) {
    const plc::Packed& p = mesh.packed[v];
    return std::array<double, 3>{p.x, p.y, p.z};
  };
  double six = 0;
  for (size_t i = 0; i < abc.size(); i += 3) {
    const auto a = coordinates(abc[i]), b = coordinates(abc[i + 1]), c = coordinates(abc[i + 2]);
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6;
}

inline size_t meeting_count(const plc::Mesh& mesh) {
  return plc::meeting_faces(mesh, kSerial).size();
}

// Every edge from its smaller end: visit(u, slot of v).
template <typename Visit>
void for_each_edge(const plc::Mesh& mesh, const Visit& visit) {
  for (uint32_t u = 0; u < mesh.slots(); ++u) {
    for (uint32_t k = 0; k < mesh.valence(u); ++k) {
      if (u < mesh.neighbor(u, k)) visit(u, k);
    }
  }
}

}  // namespace samples
