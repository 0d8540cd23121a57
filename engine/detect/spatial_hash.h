// The uniform-grid spatial hash of the vertices: constraint (3) in O(s) (3.2).
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/base/four.h"
#include "engine/mesh/mesh.h"
#include "kernels/hash_entries.h"
#include "kernels/simd.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// Buckets of a power of two; cell (x, y, z) lies in bucket (x + h(y, z)) mod buckets, so that the
// cells of a row along x are neighbours in memory and a query walks one run per row. Different rows
// may share buckets, and a vertex may have entries where it was before: a query compares what it
// comes across with where the vertex is now.
//
//   start    uint32 per bucket + 1     first entry of the bucket
//   entries  uint32 per vertex         ids, by bucket, then in ascending order
//   places   uint32 per vertex         where the vertex of the entry was, to 1/32 of a cell: most
//                                      that lie outside of a box are told without looking them up
//   late     8 bytes per insertion     what was inserted since: a list per 4 buckets
//
// While building another 12 bytes per vertex of a sixteenth of the buckets, for each thread.
class SpatialHash {
 public:
  explicit SpatialHash(SimdTarget simd = best_simd_target()) : simd_(simd) {}

  // All living vertices of the mesh that are not absent. cell > 0, mesh units; no vertex is 2^26
  // cells from the origin. slack >= 0: how far a vertex may be, on each axis, from where it was
  // when it was last entered: queries look that much farther. The same table for any executor.
  void build(const Mesh& mesh, float cell, const Executor& executor, float slack = 0);
  // From now on a vertex may be this far from where it was when it was last entered.
  void set_slack(float slack) { slack_ = slack; }
  // A vertex that was created since, or has moved by more than the slack: to be called before it is
  // asked for.
  void insert(uint32_t v, Vec3 p);
  // Several of them. No vertex is listed twice.
  void insert(const Mesh& mesh, const Vector<uint32_t>& ids, const Executor& executor);
  // Entries that insert() has made since build().
  size_t inserted() const { return late_.size(); }

  // The vertices within the box [low, high], some perhaps twice, and perhaps some that have been
  // deleted; always in the same order. The other buffers are scratch memory.
  struct Run {
    uint32_t first, last;
  };
  struct Collected {
    Buffer<uint32_t> ids;
    Buffer<uint32_t> found;
    Buffer<Run> runs;
    Buffer<kernels::EntryRun> entries;
  };
  void collect(const Mesh& mesh, Vec3 low, Vec3 high, Collected& out) const;
  // visit(id, position) for each living vertex within the box [low, high], perhaps twice; always in
  // the same order.
  template <typename Visit>
  void visit_box(const Mesh& mesh, Vec3 low, Vec3 high, Visit&& visit) const;

 private:
  static constexpr uint32_t kEnd = ~0U;
  static constexpr uint32_t kLateShift = 2;  // buckets per list, as a power of two
  struct Late {
    uint32_t id, next;
  };
  static constexpr int32_t kQuantaShift = 5;  // quanta per cell, as a power of two
  FourInts quanta(Four p) const { return floor_four(p * inverse_quantum_); }
  FourInts quanta(Vec3 p) const { return quanta(Four{p.x, p.y, p.z, 0}); }
  uint32_t row(int32_t y, int32_t z) const {
    return static_cast<uint32_t>(y) * 73856093U ^ static_cast<uint32_t>(z) * 19349663U;
  }
  // Whether queries of v's bucket come across it; they know it to be here then.
  bool refresh(uint32_t v, FourInts quanta);
  void enter(uint32_t v, uint32_t b);
  // visit(id) of what was inserted in buckets b .. last, and some next to them.
  template <typename Visit>
  void visit_late(uint32_t b, uint32_t last, const Visit& visit) const;
  uint32_t bucket(FourInts quanta) const {
    const FourInts cell = quanta >> kQuantaShift;
    return (static_cast<uint32_t>(cell[0]) + row(cell[1], cell[2])) & mask_;
  }
  // What a query looks at.
  struct Reach {
    FourInts low, high;  // quanta
    CoarseBox box() const {
      int32_t from[4], to[4];
      store_four(low, from);
      store_four(high, to);
      return coarse_box(from, to);
    }
  };
  Reach reach(Vec3 low, Vec3 high) const {
    const Four far = Four{} + slack_;
    return {quanta(Four{low.x, low.y, low.z, 0} - far),
            quanta(Four{high.x, high.y, high.z, 0} + far)};
  }
  // visit(first bucket, number of buckets - 1) for each row of cells.
  template <typename Visit>
  void visit_rows(const Reach& reach, const Visit& visit) const;
  // visit(b, last) for the runs of buckets b .. last that make up `run + 1` buckets from `first`
  // on: two where the table's end lies between.
  template <typename Visit>
  void visit_runs(uint32_t first, uint32_t run, const Visit& visit) const;

  SimdTarget simd_;
  float inverse_quantum_ = 1;
  float slack_ = 0;
  uint32_t mask_ = 0;
  Buffer<uint32_t> start_;
  Buffer<uint32_t> entries_;
  Buffer<CoarsePlace> places_;
  Buffer<uint32_t> late_head_;
  Buffer<Late> late_;
  Buffer<uint32_t> part_start_;
  std::vector<Vector<uint32_t>> missing_;  // per task: those that insert() has to enter
};

template <typename Visit>
void SpatialHash::visit_runs(uint32_t first, uint32_t run, const Visit& visit) const {
  for (uint32_t k = 0; k <= run;) {
    const uint32_t b = (first + k) & mask_;
    const uint32_t last = std::min(b + (run - k), mask_);
    visit(b, last);
    k += last - b + 1;
  }
}

template <typename Visit>
void SpatialHash::visit_late(uint32_t b, uint32_t last, const Visit& visit) const {
  for (uint32_t l = b >> kLateShift; l <= last >> kLateShift; ++l) {
    for (uint32_t i = late_head_[l]; i != kEnd; i = late_[i].next) visit(late_[i].id);
  }
}

template <typename Visit>
void SpatialHash::visit_box(const Mesh& mesh, Vec3 low, Vec3 high, Visit&& visit) const {
  const auto look = [&](uint32_t v) {
    const Float4& p = mesh.position[v];
    if (p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z &&
        p.z <= high.z && mesh.alive(v)) {
      visit(v, Vec3{p.x, p.y, p.z});
    }
  };
  const Reach reached = reach(low, high);
  const CoarseBox box = reached.box();
  visit_rows(reached, [&](uint32_t first, uint32_t run) {
    visit_runs(first, run, [&](uint32_t b, uint32_t last) {
      for (uint32_t i = start_[b]; i < start_[last + 1]; ++i) {
        if (may_be_within(places_[i], box)) look(entries_[i]);
      }
      if (!late_.empty()) visit_late(b, last, look);
    });
  });
}

template <typename Visit>
void SpatialHash::visit_rows(const Reach& reach, const Visit& visit) const {
  const FourInts low = reach.low >> kQuantaShift, high = reach.high >> kQuantaShift;
  const auto run = static_cast<uint32_t>(high[0] - low[0]);
  for (int32_t z = low[2]; z <= high[2]; ++z) {
    for (int32_t y = low[1]; y <= high[1]; ++y) {
      visit((static_cast<uint32_t>(low[0]) + row(y, z)) & mask_, run);
    }
  }
}

}  // namespace plc
