#include "engine/measure/edge_ring.h"

#include <cmath>
#include <span>

#include "engine/base/double3.h"
#include "engine/measure/mesh_topology.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr double kPi = 3.141592653589793;
// What a sum of angles may be off: paths past a vertex of so little more than a plane's angles are
// found without it, with the square of this as the error.
constexpr double kAngleMargin = 1e-9;

// Walks from face to face around the vertex of `start`, over the edge opposite to `leaving`.
// Returns the number of faces entered; closed: the walk came back. Every edge on it has at most two
// faces.
size_t walk(const uint32_t* abc, const EdgeRings& edges, uint32_t start, uint32_t leaving,
            bool& closed) {
  size_t count = 0;
  closed = false;
  for (;;) {
    const uint32_t apex = edges.across(leaving);
    if (apex == leaving) return count;
    const bool next = abc[next_corner(apex)] == abc[start];
    const uint32_t own = next ? next_corner(apex) : previous_corner(apex);
    if (own == start) {
      closed = true;
      return count;
    }
    ++count;
    leaving = next ? previous_corner(apex) : next_corner(apex);
  }
}

bool may_bend(const MeshArrays& mesh, std::span<const uint32_t> corners, const EdgeRings& edges) {
  double angle = 0;
  for (const uint32_t c : corners) {
    for (const uint32_t side : {next_corner(c), previous_corner(c)}) {
      if (edges.across(edges.across(side)) != side) return true;  // an edge of several faces
    }
    const Double3 u = difference(mesh.corner(next_corner(c)), mesh.corner(c));
    const Double3 v = difference(mesh.corner(previous_corner(c)), mesh.corner(c));
    const double twice = length(cross(u, v));
    if (!(twice > 0)) return true;
    angle += std::atan2(twice, dot(u, v));
  }
  bool closed = false;
  const uint32_t start = corners[0];
  size_t faces = 1 + walk(mesh.abc, edges, start, previous_corner(start), closed);
  bool unused = false;
  if (!closed) faces += walk(mesh.abc, edges, start, next_corner(start), unused);
  return faces != corners.size() || angle > (closed ? 2 : 1) * kPi * (1 + kAngleMargin);
}

}  // namespace

EdgeRings::EdgeRings(const uint32_t* abc, size_t face_count, size_t vertex_count,
                     const Executor& executor) {
  across_.resize_uninitialized(3 * face_count);
  for (size_t c = 0; c < 3 * face_count; ++c) across_[c] = static_cast<uint32_t>(c);
  const EdgeTable edges(abc, face_count, vertex_count, executor);
  edges.visit(0, vertex_count, [&](uint32_t, uint32_t, const EdgeUse* use, const EdgeUse* end) {
    for (const EdgeUse* u = use; u != end; ++u) {
      const EdgeUse* next = u + 1 == end ? use : u + 1;
      across_[previous_corner(u->corner)] = previous_corner(next->corner);
    }
  });
}

Vector<uint8_t> bending_vertices(const MeshArrays& mesh, const VertexCorners& corners,
                                 const EdgeRings& edges) {
  Vector<uint8_t> bends(corners.vertex_count(), 0);
  for (size_t v = 0; v < bends.size(); ++v) {
    if (!corners.of(v).empty()) bends[v] = may_bend(mesh, corners.of(v), edges) ? 1 : 0;
  }
  return bends;
}

}  // namespace plc
