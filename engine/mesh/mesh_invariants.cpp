#include "engine/mesh/mesh_invariants.h"

#include <algorithm>
#include <cmath>

namespace plc {

namespace {

std::string at_vertex(uint32_t v, const std::string& what) {
  return "vertex " + std::to_string(v) + ": " + what;
}

std::string broken_ring(const Mesh& mesh, uint32_t v) {
  const Neighbors ring = mesh.ring(v);
  if (ring.size() < 3) return at_vertex(v, "valence " + std::to_string(ring.size()));
  for (uint32_t k = 0; k < ring.size(); ++k) {
    const uint32_t w = ring[k];
    if (w >= mesh.slots() || w == v || !mesh.alive(w)) {
      return at_vertex(v, "neighbour " + std::to_string(w) + " is no living other vertex");
    }
    if (std::count(ring.begin(), ring.end(), w) != 1) {
      return at_vertex(v, "neighbour " + std::to_string(w) + " stands twice in the ring");
    }
    // Face (v, w, x): in the ring of w, x must be followed by v.
    const uint32_t x = ring.next(k);
    const Neighbors other = mesh.ring(w);
    const uint32_t j = other.find(x);
    if (j == other.size() || other.next(j) != v) {
      return at_vertex(v, "face with " + std::to_string(w) + " and " + std::to_string(x) +
                              " is not seen from " + std::to_string(w));
    }
  }
  return {};
}

}  // namespace

std::string broken_invariant(const Mesh& mesh) {
  uint32_t living = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (!mesh.alive(v)) continue;
    ++living;
    if (std::string broken = broken_ring(mesh, v); !broken.empty()) return broken;
    const Float4& p = mesh.position[v];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      return at_vertex(v, "its position is not finite");
    }
  }
  if (living != mesh.vertex_count()) return "the count of living vertices is wrong";
  return {};
}

}  // namespace plc
