// Copies of meshes, which have none of their own: benchmarks start every repetition from one state.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/mesh/mesh.h"
#include "engine/mesh/state_hash.h"
#include "pyramid/memory.h"

namespace bench {

// The living vertices in the order of their ids, which are without gaps in the copy.
inline void copy_mesh(const plc::Mesh& from, plc::Mesh& to) {
  to.clear();
  to.delta = from.delta;
  to.reserve(from.vertex_count());
  plc::Vector<uint32_t> rank(from.slots());
  for (uint32_t v = 0; v < from.slots(); ++v) {
    if (from.alive(v)) rank[v] = to.create(from.at(v), from.velocity.at(v));
  }
  for (uint32_t v = 0; v < from.slots(); ++v) {
    if (!from.alive(v)) continue;
    const uint32_t w = rank[v];
    plc::Neighbors ring;
    for (uint32_t k = 0; k < from.valence(v); ++k) ring.push_back(rank[from.neighbor(v, k)]);
    to.set_ring(w, ring);
    to.normal.set(w, from.normal.at(v));
    to.displacement.set(w, from.displacement.at(v));
    to.path[w] = from.path[v];
    to.cut_id[w] = from.cut_id[v];
    to.cut_iteration[w] = from.cut_iteration[v];
  }
}

inline plc::Mesh copy_of(const plc::Mesh& mesh) {
  plc::Mesh copy;
  copy_mesh(mesh, copy);
  return copy;
}

// The engine's own hash, of a mesh whose ids may have gaps.
inline uint64_t hash_of(const plc::Mesh& mesh) {
  return plc::state_hash(copy_of(mesh));
}

// 64-bit FNV-1a.
inline uint64_t hash_bytes(const void* data, size_t bytes, uint64_t hash = 14695981039346656037U) {
  const auto* p = static_cast<const unsigned char*>(data);
  for (size_t i = 0; i < bytes; ++i) hash = (hash ^ p[i]) * 1099511628211U;
  return hash;
}

}  // namespace bench
