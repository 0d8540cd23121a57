// One mesh added to another.
#pragma once

#include "engine/mesh/mesh.h"
#include "pyramid/memory.h"

namespace plc {

// Adds the living vertices of `part`, at place(position), at rest, and its rings; `inward`: turned
// inside out. Ids follow in the order of part's. What meets is the caller's care.
template <typename Place>
void append_mesh(Mesh& mesh, const Mesh& part, bool inward, const Place& place) {
  Vector<uint32_t> id(part.slots());
  for (uint32_t v = 0; v < part.slots(); ++v) {
    if (part.alive(v)) id[v] = mesh.create(place(part.at(v)), {});
  }
  for (uint32_t v = 0; v < part.slots(); ++v) {
    if (!part.alive(v)) continue;
    const Neighbors from = part.ring(v);
    Neighbors ring;
    for (uint32_t n = 0; n < from.size(); ++n) {
      ring.push_back(id[from[inward ? from.size() - 1 - n : n]]);
    }
    mesh.set_ring(id[v], ring);
  }
}

}  // namespace plc
