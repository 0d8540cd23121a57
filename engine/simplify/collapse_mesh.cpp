#include "engine/simplify/collapse_mesh.h"

#include <algorithm>

#include "engine/measure/edge_ring.h"

namespace plc {

CollapseMesh::CollapseMesh(const MeshArrays& mesh, const Executor& executor) {
  xyz_.resize_uninitialized(3 * mesh.vertex_count);
  abc_.resize_uninitialized(3 * mesh.face_count);
  across_.resize_uninitialized(3 * mesh.face_count);
  corner_of_.resize_uninitialized(mesh.vertex_count);
  std::copy(mesh.xyz, mesh.xyz + xyz_.size(), xyz_.begin());
  std::copy(mesh.abc, mesh.abc + abc_.size(), abc_.begin());
  std::fill(corner_of_.begin(), corner_of_.end(), kNoCorner);
  const EdgeRings edges(mesh.abc, mesh.face_count, mesh.vertex_count, executor);
  for (uint32_t c = 0; c < abc_.size(); ++c) {
    across_[c] = edges.across(c);
    if (corner_of_[abc_[c]] == kNoCorner) {
      corner_of_[abc_[c]] = c;
      ++living_vertices_;
    }
  }
  living_faces_ = mesh.face_count;
}

uint32_t CollapseMesh::corner_to(uint32_t u, uint32_t v) const {
  uint32_t found = kNoCorner;
  around(u, [&](uint32_t c) {
    if (abc_[next_corner(c)] == v) found = c;
  });
  return found;
}

// The face of this corner dies: the faces across its two edges that are to be one become
// neighbours. The corner's vertex is not on the edge that collapses.
void CollapseMesh::join(uint32_t dying) {
  const uint32_t n = next_corner(dying), p = previous_corner(dying);
  const uint32_t x = across_[n], y = across_[p];
  across_[x] = y;
  across_[y] = x;
  // Corners of living faces: the apex, and what becomes of the edge.
  corner_of_[abc_[dying]] = next_corner(x);
  for (const uint32_t c : {dying, n, p}) across_[c] = kNoCorner;
  --living_faces_;
}

void CollapseMesh::collapse(uint32_t corner, const Double3& place) {
  const uint32_t u = abc_[corner], v = abc_[next_corner(corner)];
  const uint32_t first = previous_corner(corner), second = across_[first];
  around(v, [&](uint32_t c) { abc_[c] = u; });
  // The corner of u across the first face's other edge survives both joins.
  const uint32_t kept = across_[next_corner(corner)];
  join(first);
  join(second);
  corner_of_[u] = next_corner(kept);
  corner_of_[v] = kNoCorner;
  --living_vertices_;
  double* p = xyz_.data() + 3 * static_cast<size_t>(u);
  p[0] = place.x, p[1] = place.y, p[2] = place.z;
}

}  // namespace plc
