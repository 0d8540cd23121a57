// From face to face over edges of any mesh, and the vertices at which shortest paths may bend.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "engine/measure/vertex_corners.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// The corners opposite to an edge, in a ring. 4 bytes per corner.
class EdgeRings {
 public:
  EdgeRings(const uint32_t* abc, size_t face_count, size_t vertex_count, const Executor& executor);

  // The next corner that faces the edge opposite to this corner: itself on a border, and in a face
  // that repeats a vertex.
  uint32_t across(uint32_t corner) const { return across_[corner]; }

 private:
  Buffer<uint32_t> across_;
};

// 0 for vertices that no shortest path needs to pass through: those whose faces are one closed fan
// of at most 360 degrees or one open fan of at most 180. 1 for others, and at faces of no area.
Vector<uint8_t> bending_vertices(const MeshArrays& mesh, const VertexCorners& corners,
                                 const EdgeRings& edges);

}  // namespace plc
