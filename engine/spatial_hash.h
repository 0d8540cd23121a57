// The uniform-grid spatial hash of the vertices: constraint (3) in O(s) (3.2).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "engine/mesh.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"

namespace plc {

// Buckets of a power of two; cell (x, y, z) lies in bucket (x + h(y, z)) mod buckets, so that the
// cells of a row along x are neighbours in memory and a query walks one run per row. Different rows
// may share buckets: a query can see a vertex twice, and vertices outside its box.
//
//   start    uint32 per bucket + 1   first entry of the bucket
//   entries  16 bytes per vertex     position and id, by bucket, then by id
//   late     what was inserted since: a list per bucket
class SpatialHash {
 public:
  struct Entry {
    float x, y, z;
    uint32_t id;
  };

  // All living vertices of the mesh. cell > 0, mesh units.
  void build(const Mesh& mesh, float cell, const Executor& executor);
  // A vertex that was created or moved since; its old entry, if any, is ignored from now on by
  // queries, which compare entries with the mesh.
  void insert(uint32_t v, Vec3 p);

  // visit(id, position) for each living vertex within the box [low, high], perhaps twice; always in
  // the same order.
  template <typename Visit>
  void visit_box(const Mesh& mesh, Vec3 low, Vec3 high, Visit&& visit) const;

 private:
  static constexpr uint32_t kEnd = ~0U;
  struct Late {
    Entry entry;
    uint32_t next;
  };
  int32_t cell_of(float x) const { return static_cast<int32_t>(std::floor(x * inverse_cell_)); }
  uint32_t row(int32_t y, int32_t z) const {
    return static_cast<uint32_t>(y) * 73856093U ^ static_cast<uint32_t>(z) * 19349663U;
  }
  uint32_t bucket(Vec3 p) const {
    return (static_cast<uint32_t>(cell_of(p.x)) + row(cell_of(p.y), cell_of(p.z))) & mask_;
  }
  static bool current(const Mesh& mesh, const Entry& e) {
    const Packed& p = mesh.packed[e.id];
    return mesh.alive(e.id) && p.x == e.x && p.y == e.y && p.z == e.z;
  }

  float inverse_cell_ = 1;
  uint32_t mask_ = 0;
  Buffer<uint32_t> start_;
  Buffer<uint32_t> bucket_of_;
  Buffer<Entry> entries_;
  Buffer<uint32_t> late_head_;
  Buffer<Late> late_;
};

template <typename Visit>
void SpatialHash::visit_box(const Mesh& mesh, Vec3 low, Vec3 high, Visit&& visit) const {
  const auto look = [&](const Entry& e) {
    if (e.x >= low.x && e.x <= high.x && e.y >= low.y && e.y <= high.y && e.z >= low.z &&
        e.z <= high.z && current(mesh, e)) {
      visit(e.id, Vec3{e.x, e.y, e.z});
    }
  };
  const int32_t x0 = cell_of(low.x);
  const uint32_t run = static_cast<uint32_t>(cell_of(high.x) - x0);
  const int32_t y1 = cell_of(high.y);
  const int32_t z1 = cell_of(high.z);
  for (int32_t z = cell_of(low.z); z <= z1; ++z) {
    for (int32_t y = cell_of(low.y); y <= y1; ++y) {
      const uint32_t first = (static_cast<uint32_t>(x0) + row(y, z)) & mask_;
      for (uint32_t k = 0; k <= run;) {
        const uint32_t b = (first + k) & mask_;
        const uint32_t last = std::min(b + (run - k), mask_);
        for (uint32_t i = start_[b]; i < start_[last + 1]; ++i) look(entries_[i]);
        k += last - b + 1;
      }
      if (late_.empty()) continue;
      for (uint32_t k = 0; k <= run; ++k) {
        const uint32_t head = late_head_[(first + k) & mask_];
        for (uint32_t i = head; i != kEnd; i = late_[i].next) look(late_[i].entry);
      }
    }
  }
}

}  // namespace plc
