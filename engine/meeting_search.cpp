#include "engine/meeting_search.h"

#include <algorithm>
#include <limits>

#include "engine/blocks.h"

namespace plc {
namespace {

constexpr size_t kMovedBlock = 2048;
constexpr size_t kFaceBlock = 4096;
// The table is sorted in this many pieces of consecutive places, each a task that fits a cache.
constexpr size_t kPartitions = 64;
// Edges per cell: smaller cells put a face into more of them, larger ones make it meet more
// strangers. Measured in perf terms below 1.0 and above 1.5 are slower.
constexpr float kCellEdges = 1.0F;
// Cells per axis at most: indices stay exact in float.
constexpr float kMaxCells = 1 << 20;

void join(FaceBox& a, const FaceBox& b) {
  for (int k = 0; k < 4; ++k) {
    a.low[k] = std::min(a.low[k], b.low[k]);
    a.high[k] = std::max(a.high[k], b.high[k]);
  }
}

FaceBox empty_box() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  FaceBox box{};
  std::fill(box.low, box.low + 4, kInfinity);
  std::fill(box.high, box.high + 4, -kInfinity);
  return box;
}

}  // namespace

void MeetingSearch::place_grid(const Packed* positions, const uint32_t* abc, const uint32_t* moved,
                               size_t count, float max_edge, const Executor& executor) {
  block_boxes_.resize(block_count(count, kMovedBlock));
  run_blocks(executor, count, kMovedBlock, [&](size_t block, size_t begin, size_t end) {
    FaceBox all = empty_box();
    for (size_t i = begin; i < end; ++i) {
      join(all, face_box(positions, abc + 3 * static_cast<size_t>(moved[i])));
    }
    block_boxes_[block] = all;
  });
  moved_box_ = empty_box();
  for (const FaceBox& box : block_boxes_) join(moved_box_, box);
  float size = kCellEdges * max_edge;
  for (int axis = 0; axis < 3; ++axis) {
    origin_[axis] = moved_box_.low[axis];
    size = std::max(size, (moved_box_.high[axis] - origin_[axis]) / kMaxCells);
  }
  per_cell_ = 1 / size;
  for (int axis = 0; axis < 3; ++axis) last_[axis] = cell(axis, moved_box_.high[axis]);
  // Row by row, wrapped around the table: cells that are near are mostly near in memory. Odd
  // strides, lest rows fall onto each other.
  stride_[0] = (static_cast<uint32_t>(last_[0]) + 1) | 1U;
  stride_[1] = (stride_[0] * (static_cast<uint32_t>(last_[1]) + 1)) | 1U;
}

MeetingSearch::Cells MeetingSearch::cells_of(const FaceBox& box) const {
  Cells cells{};
  for (int axis = 0; axis < 3; ++axis) {
    // Clamped before the conversion: faces that pass by may reach far out of the grid.
    cells.low[axis] = cell(axis, std::max(box.low[axis], moved_box_.low[axis]));
    cells.high[axis] = cell(axis, std::min(box.high[axis], moved_box_.high[axis]));
  }
  return cells;
}

// A counting sort of the entries by place in two passes: by partition, over fixed blocks; then by
// place within each partition.
void MeetingSearch::fill(const Packed* positions, const uint32_t* abc, const uint32_t* moved,
                         size_t count, const Executor& executor) {
  const size_t blocks = block_count(count, kMovedBlock);
  const auto for_entries = [&](size_t begin, size_t end, const auto& visit) {
    for (size_t i = begin; i < end; ++i) {
      const FaceBox box = face_box(positions, abc + 3 * static_cast<size_t>(moved[i]));
      const Cells c = cells_of(box);
      for (int32_t z = c.low[2]; z <= c.high[2]; ++z) {
        for (int32_t y = c.low[1]; y <= c.high[1]; ++y) {
          for (int32_t x = c.low[0]; x <= c.high[0]; ++x) visit(box, moved[i], x, y, z);
        }
      }
    }
  };
  // About one place per entry; a face touches some 3.4 cells.
  uint32_t places = kPartitions;
  while (places < 4 * count && places < (1U << 30U)) places *= 2;
  mask_ = places - 1;
  const uint32_t per_partition = places / kPartitions;
  counts_.resize_uninitialized(kPartitions * blocks);
  run_blocks(executor, count, kMovedBlock, [&](size_t block, size_t begin, size_t end) {
    uint32_t counts[kPartitions] = {};
    for_entries(begin, end, [&](const FaceBox&, uint32_t, int32_t x, int32_t y, int32_t z) {
      ++counts[place(x, y, z) / per_partition];
    });
    for (size_t p = 0; p < kPartitions; ++p) counts_[p * blocks + block] = counts[p];
  });
  uint32_t total = 0;
  for (uint32_t& c : counts_) {
    const uint32_t here = c;
    c = total;
    total += here;
  }
  unsorted_.resize_uninitialized(total);
  entries_.resize_uninitialized(total);
  begin_.resize_uninitialized(places + 1);
  begin_[places] = total;
  run_blocks(executor, count, kMovedBlock, [&](size_t block, size_t begin, size_t end) {
    uint32_t next[kPartitions];
    for (size_t p = 0; p < kPartitions; ++p) next[p] = counts_[p * blocks + block];
    for_entries(begin, end, [&](const FaceBox& box, uint32_t f, int32_t x, int32_t y, int32_t z) {
      const uint32_t at = place(x, y, z);
      unsorted_[next[at / per_partition]++] = {
          {box.low[0], box.low[1], box.low[2]}, {box.high[0], box.high[1], box.high[2]}, f, at};
    });
  });
  executor.run(kPartitions, [&](size_t p) { sort_partition(p); });
}

void MeetingSearch::sort_partition(size_t partition) {
  const size_t blocks = counts_.size() / kPartitions;
  const size_t begin = counts_[partition * blocks];
  const size_t end =
      partition + 1 < kPartitions ? counts_[(partition + 1) * blocks] : unsorted_.size();
  const size_t per_partition = (static_cast<size_t>(mask_) + 1) / kPartitions;
  uint32_t* places = begin_.data() + partition * per_partition;
  const size_t first = partition * per_partition;
  std::fill(places, places + per_partition, 0U);
  for (size_t i = begin; i < end; ++i) ++places[unsorted_[i].place - first];
  auto total = static_cast<uint32_t>(begin);
  for (size_t p = 0; p < per_partition; ++p) {
    total += places[p];
    places[p] = total;
  }
  for (size_t i = end; i-- > begin;) entries_[--places[unsorted_[i].place - first]] = unsorted_[i];
}

void MeetingSearch::search_block(const Packed* positions, const uint32_t* abc, size_t begin,
                                 size_t end, const uint32_t* moved, const uint32_t* moved_end,
                                 std::vector<FacePair>& pairs) const {
  const uint32_t* next_moved = std::lower_bound(moved, moved_end, static_cast<uint32_t>(begin));
  for (size_t i = begin; i < end; ++i) {
    const auto f = static_cast<uint32_t>(i);
    const bool f_moved = next_moved != moved_end && *next_moved == f;
    next_moved += f_moved ? 1 : 0;
    const FaceBox box = face_box(positions, abc + 3 * i);
    if (!boxes_overlap(box, moved_box_)) continue;
    const Cells c = cells_of(box);
    const auto visit_cell = [&](int32_t x, int32_t y, int32_t z) {
      const uint32_t at = place(x, y, z);
      for (uint32_t e = begin_[at]; e < begin_[at + 1]; ++e) {
        const Entry& entry = entries_[e];
        // Two moved faces see each other twice: the smaller one's turn counts.
        if (f_moved && entry.face <= f) continue;
        bool apart = false;
        for (int axis = 0; axis < 3; ++axis) {
          apart |= (entry.low[axis] > box.high[axis]) | (box.low[axis] > entry.high[axis]);
        }
        if (apart) continue;
        // They share one or more cells: the one with the lowest common corner counts. It also
        // tells this cell from others at the same place of the table.
        if (cell(0, std::max(box.low[0], entry.low[0])) != x ||
            cell(1, std::max(box.low[1], entry.low[1])) != y ||
            cell(2, std::max(box.low[2], entry.low[2])) != z) {
          continue;
        }
        const uint32_t* g = abc + 3 * static_cast<size_t>(entry.face);
        if (triangles_intersect(make_triangle(positions, abc + 3 * i),
                                make_triangle(positions, g))) {
          pairs.emplace_back(std::min(f, entry.face), std::max(f, entry.face));
        }
      }
    };
    for (int32_t z = c.low[2]; z <= c.high[2]; ++z) {
      for (int32_t y = c.low[1]; y <= c.high[1]; ++y) {
        for (int32_t x = c.low[0]; x <= c.high[0]; ++x) visit_cell(x, y, z);
      }
    }
  }
}

const std::vector<FacePair>& MeetingSearch::find(const Packed* positions, const uint32_t* abc,
                                                 size_t face_count, const uint32_t* moved,
                                                 size_t moved_count, float max_edge,
                                                 const Executor& executor) {
  pairs_.clear();
  if (moved_count == 0) return pairs_;
  place_grid(positions, abc, moved, moved_count, max_edge, executor);
  fill(positions, abc, moved, moved_count, executor);
  found_.resize(std::max(found_.size(), block_count(face_count, kFaceBlock)));
  run_blocks(executor, face_count, kFaceBlock, [&](size_t block, size_t begin, size_t end) {
    found_[block].clear();
    search_block(positions, abc, begin, end, moved, moved + moved_count, found_[block]);
  });
  for (size_t block = 0; block < block_count(face_count, kFaceBlock); ++block) {
    pairs_.insert(pairs_.end(), found_[block].begin(), found_[block].end());
  }
  std::sort(pairs_.begin(), pairs_.end());
  return pairs_;
}

}  // namespace plc
