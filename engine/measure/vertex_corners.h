// The corners of the faces around each vertex of any mesh.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "pyramid/buffer.h"

namespace plc {

// Corner c = 3 f + k is vertex abc[c] of face f = c / 3. 4 bytes per corner and per vertex.
class VertexCorners {
 public:
  // Faces that repeat a vertex are left out.
  VertexCorners(const uint32_t* abc, size_t face_count, size_t vertex_count);

  size_t vertex_count() const { return begin_.size() - 1; }
  // Ascending.
  std::span<const uint32_t> of(size_t vertex) const {
    return {corners_.data() + begin_[vertex], corners_.data() + begin_[vertex + 1]};
  }

 private:
  Buffer<uint32_t> begin_;  // per vertex, and the end
  Buffer<uint32_t> corners_;
};

inline bool has_repeated_vertex(const uint32_t* ids) {
  return ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0];
}
inline uint32_t next_corner(uint32_t corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}
inline uint32_t previous_corner(uint32_t corner) {
  return corner % 3 == 0 ? corner + 2 : corner - 1;
}

}  // namespace plc
