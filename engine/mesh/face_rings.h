// From an indexed triangle mesh to oriented neighbour rings (3.1).
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/status.h"

namespace plc {

// The ring of each vertex of a mesh that is closed, oriented and has two faces at every edge.
//
//   begin   uint32 per vertex + 1   first entry of the vertex; it has as many as faces
//   ring    uint32 per corner       the neighbours of the first umbrella, from the smallest id on
//   length  uint32 per vertex       of that umbrella: less than the vertex's faces where it has
//                                   several and so is no vertex of a manifold
class FaceRings {
 public:
  // Three ids below vertex_count per face; at most kMaxFaces faces. The same for any executor.
  FaceRings(const uint32_t* abc, size_t face_count, size_t vertex_count, const Executor& executor);

  uint32_t faces(size_t v) const { return begin_[v + 1] - begin_[v]; }
  uint32_t length(size_t v) const { return length_[v]; }
  // length(v) ids, counter-clockwise seen from outside.
  const uint32_t* ring(size_t v) const { return ring_.data() + begin_[v]; }

 private:
  struct Step;
  Buffer<uint32_t> begin_, ring_, length_;
};

// Replaces what is in the mesh, but for delta. xyz: three floats per vertex; the rings are of a
// manifold. Vertices without a face are left out, the others keep their order: ids without gaps. At
// rest, every vertex due for a check.
void fill_from_rings(Mesh& mesh, const float* xyz, size_t vertex_count, const FaceRings& rings);

// kOutOfMemory: it would be more than kMaxMeshVertices.
Status too_many_vertices();

}  // namespace plc
