// The vertices of a surface by the blocks of a grid, which are thinned out at once (thinning.h).
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/base/vec3.h"
#include "engine/start/half_edges.h"
#include "kernels/box_lanes.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// Where a vertex is, and the size that the mesh has there; mesh units.
struct SizedPlace {
  Vec3 at;
  float size;
};

// What holds all of them; there is at least one.
Box3 bounds_of(const Buffer<SizedPlace>& places);

// Those vertices of the surface that are still there. The same for any executor.
class ThinningGrid {
 public:
  // bounds: of the places; side: of a block; the grid is moved by `shift` of it along each axis.
  ThinningGrid(const Buffer<SizedPlace>& places, const HalfEdges& surface, const Box3& bounds,
               float side, float shift, const Executor& executor);

  size_t blocks() const { return begin_.size() - 1; }
  // That in which v lies.
  uint32_t block(uint32_t v) const { return block_[v]; }
  // Ascending.
  std::span<const uint32_t> vertices(size_t block) const {
    return {ids_.data() + begin_[block], ids_.data() + begin_[block + 1]};
  }

 private:
  Buffer<uint32_t> block_;  // of each vertex
  Vector<size_t> begin_;    // of each block, in ids_
  Buffer<uint32_t> ids_;
};

}  // namespace plc
