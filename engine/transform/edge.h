// What the transformations ask about an edge and its two faces.
#pragma once
#include <cassert>

#include "engine/mesh/mesh.h"

namespace plc {

// The edge u-v with its faces (u, a, v) and (u, v, b): a precedes v in the ring of u, b follows it.
struct Edge {
  uint32_t u, v, a, b;
};

// The edge to neighbour k of u.
inline Edge edge_at(const Mesh& mesh, uint32_t u, uint32_t k) {
  const uint32_t d = mesh.valence(u);
  assert(k < d);
  return {u, mesh.neighbor(u, k), mesh.neighbor(u, k == 0 ? d - 1 : k - 1),
          mesh.neighbor(u, k + 1 == d ? 0 : k + 1)};
}

// v must be a neighbour of u.
inline Edge edge_between(const Mesh& mesh, uint32_t u, uint32_t v) {
  uint32_t k = 0;
  while (mesh.neighbor(u, k) != v) ++k;
  return edge_at(mesh, u, k);
}

// Twice the area vector of the face (a, b, c), outward for counter-clockwise corners.
inline Vec3 area_vector(Vec3 a, Vec3 b, Vec3 c) {
  return cross(b - a, c - a);
}
inline Vec3 area_vector(const Mesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
  return area_vector(mesh.at(a), mesh.at(b), mesh.at(c));
}

// The sum of the area vectors around v, unit length, from the positions of now.
Vec3 vertex_normal(const Mesh& mesh, uint32_t v);

// Whether a face around v turns further from that than by the angle of the cosine.
bool bends(const Mesh& mesh, uint32_t v, float cosine);
// The same of faces with these normals, as long as twice their areas; visit(use) calls use(normal)
// for each.
template <typename Visit>
bool normals_bend(const Visit& visit, float cosine) {
  Vec3 sum;
  visit([&](Vec3 n) { sum = sum + n; });
  const float norm = length(sum);
  bool any = false;
  visit([&](Vec3 n) { any = any || dot(n, sum) < cosine * length(n) * norm; });
  return any;
}

// Whether the mesh has this edge, between these faces.
inline bool has_edge(const Mesh& mesh, const Edge& e) {
  if (!mesh.alive(e.u) || !mesh.alive(e.v) || !mesh.adjacent(e.u, e.v)) return false;
  const Edge there = edge_between(mesh, e.u, e.v);
  return there.a == e.a && there.b == e.b;
}

}  // namespace plc
