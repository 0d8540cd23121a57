// The hash that determinism is tested by (plc_surface_hash).
#pragma once
#include <cstdint>

#include "engine/mesh.h"

namespace plc {

// 64-bit FNV-1a over, little endian: the number of vertices (u64); the bits of x, y, z of each
// vertex (three u32); each vertex's valence and its ring from the smallest neighbour on (u32 each).
// Vertices in the order of their ids; the mesh has no deleted ids (see Mesh::renumber).
uint64_t state_hash(const Mesh& mesh);

}  // namespace plc
