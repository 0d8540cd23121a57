// The hash that determinism is tested by (plc_surface_hash).
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/base/fnv.h"
#include "engine/mesh/mesh.h"

namespace plc {

// 64-bit FNV-1a over, little endian: the number of vertices (u64); the bits of x, y, z of each
// vertex (three u32); each vertex's valence and its ring from the smallest neighbour on (u32 each).
// Vertices in the order of their ids; the mesh has no deleted ids (see Mesh::renumber).
uint64_t state_hash(const Mesh& mesh);

// The hash of one part of a run's state, and its name.
struct PartHash {
  std::string_view part;
  uint64_t hash = 0;
  friend bool operator==(const PartHash&, const PartHash&) = default;
};
PartHash part_hash(std::string_view part, const Streams3& streams);
PartHash part_hash(std::string_view part, const Buffer<Float4>& records);
template <typename Range>
PartHash part_hash(std::string_view part, const Range& values) {
  Fnv hash;
  hash.add_all(values);
  return {part, hash.value()};
}

// All that a mesh hands on from pass to pass, a hash for each stream: padding and deleted vertices
// included, rings from slot 0 on, the free ids in the order in which they will be taken.
std::vector<PartHash> part_hashes(const Mesh& mesh);

}  // namespace plc
