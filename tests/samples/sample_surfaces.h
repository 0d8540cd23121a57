// Meshes of the engine made from samples, and what the tests ask of them.
#pragma once
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/mesh_arrays.h"
#include "engine/exact/self_intersection.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/mesh_invariants.h"
#include "engine/start/initial_surface.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_meshes.h"
#include "tests/samples/sample_rings.h"

namespace samples {

inline const plc::SerialExecutor kSerial;

// Vertices keep their ids; every vertex of the soup has a face.
inline void fill_mesh(plc::Mesh& mesh, const Soup& soup, double delta) {
  mesh.clear();
  const Rings rings = rings_of(soup);
  for (const plc::Float4& p : rings.positions) mesh.create({p.x, p.y, p.z}, {});
  for (uint32_t v = 0; v < rings.slots(); ++v) {
    plc::Neighbors ring;
    for (uint32_t k = 0; k < rings.valence[v]; ++k) ring.push_back(rings.view().slot(v, k));
    mesh.set_ring(v, ring);
  }
  mesh.delta = delta;
}

inline Soup tetrahedron() {
  Soup m;
  m.xyz = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
  m.abc = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2};
  return m;
}

// As high as the distance between two floats there: the middle of an edge of the apex, 3, is
// rounded into the opposite face, as are the centres of its faces.
inline Soup flat_tetrahedron() {
  Soup m;
  m.xyz = {1000, 1000, 1000, 1004, 1000, 1000, 1002, 1003.5, 1000, 1002, 1001, 1000 + 0x1p-14};
  m.abc = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  return m;
}

// Around the z axis: vertices 0 .. n-1 of a ring of radius 1, then the apexes at -height, height.
inline Soup bipyramid(uint32_t n, double height) {
  constexpr double kPi = 3.14159265358979323846;
  Soup m;
  for (uint32_t i = 0; i < n; ++i)
    m.vertex(std::cos(2 * kPi * i / n), std::sin(2 * kPi * i / n), 0);
  const uint32_t bottom = m.vertex(0, 0, -height), top = m.vertex(0, 0, height);
  for (uint32_t i = 0; i < n; ++i) {
    m.face(top, i, (i + 1) % n);
    m.face(bottom, (i + 1) % n, i);
  }
  return m;
}

// A tube along z with `rings` cross-sections of n corners and of the given radius, 1 apart, closed
// by apexes; corner i of ring r is vertex r n + i, ring by ring turned by half a side.
inline Soup tube(uint32_t n, uint32_t rings, double radius) {
  constexpr double kPi = 3.14159265358979323846;
  Soup m;
  for (uint32_t r = 0; r < rings; ++r) {
    for (uint32_t i = 0; i < n; ++i) {
      const double angle = 2 * kPi * (i + 0.5 * r) / n;
      m.vertex(radius * std::cos(angle), radius * std::sin(angle), r);
    }
  }
  const uint32_t bottom = m.vertex(0, 0, -1), top = m.vertex(0, 0, rings);
  for (uint32_t i = 0; i < n; ++i) {
    const uint32_t j = (i + 1) % n;
    m.face(bottom, j, i);
    m.face(top, (rings - 1) * n + i, (rings - 1) * n + j);
    for (uint32_t r = 0; r + 1 < rings; ++r) {
      m.face(r * n + i, r * n + j, (r + 1) * n + i);
      m.face(r * n + j, (r + 1) * n + j, (r + 1) * n + i);
    }
  }
  return m;
}

// V - E + F of a closed triangulated surface: 2 E = 3 F = the sum of the valences.
inline int64_t euler(const plc::Mesh& mesh) {
  int64_t ends = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) ends += mesh.valence(v);
  return mesh.vertex_count() - ends / 6;
}

inline int64_t component_count(const plc::Mesh& mesh) {
  plc::Vector<uint8_t> seen(mesh.slots(), 0);
  int64_t count = 0;
  for (uint32_t start = 0; start < mesh.slots(); ++start) {
    if (!mesh.alive(start) || seen[start] != 0) continue;
    ++count;
    plc::Vector<uint32_t> open{start};
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

using FaceIds = std::array<uint32_t, 3>;

// Sorted, each from its smallest corner.
inline std::vector<FaceIds> sorted_faces(const plc::Mesh& mesh) {
  const plc::Vector<uint32_t> abc = mesh.faces();
  std::vector<FaceIds> faces;
  for (size_t i = 0; i < abc.size(); i += 3) faces.push_back({abc[i], abc[i + 1], abc[i + 2]});
  std::sort(faces.begin(), faces.end());
  return faces;
}

inline double volume(const plc::Mesh& mesh) {
  const plc::Vector<uint32_t> abc = mesh.faces();
  const auto coordinates = [&](uint32_t v) {
    const plc::Float4& p = mesh.position[v];
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

// The faces that meet, pair by pair: by the search over any mesh, not the one that the guards use.
using Corners = std::array<uint32_t, 3>;
inline std::vector<std::pair<Corners, Corners>> meeting_pairs(const plc::Mesh& mesh) {
  const plc::Vector<uint32_t> abc = mesh.faces();
  std::vector<double> xyz;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const plc::Vec3 p = mesh.at(v);
    xyz.insert(xyz.end(), {p.x, p.y, p.z});
  }
  const auto corners = [&](uint32_t f) {
    const size_t at = 3 * static_cast<size_t>(f);
    return Corners{abc[at], abc[at + 1], abc[at + 2]};
  };
  std::vector<std::pair<Corners, Corners>> pairs;
  for (const auto& [f, g] : plc::self_intersections(plc::arrays_of(xyz, abc), kSerial)) {
    pairs.emplace_back(corners(f), corners(g));
  }
  return pairs;
}

// How many faces meet others.
inline size_t meeting_count(const plc::Mesh& mesh) {
  std::set<Corners> faces;
  for (const auto& [f, g] : meeting_pairs(mesh)) faces.insert({f, g});
  return faces.size();
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
