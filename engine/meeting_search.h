// The self-intersections that a step may have made: of the faces that moved, with all faces.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/self_intersection.h"
#include "engine/triangle_intersection.h"
#include "kernels/ring.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"

namespace plc {

// Made for the engine's mesh, whose faces are all of about one size, and for being asked in every
// iteration: buffers are kept, and nothing is built over the faces that did not move. The moved
// ones go into a uniform grid, in every cell that their boxes touch; then all faces pass by it.
//
//   buffer      bytes per moved face   what
//   unsorted    ~110 (32 per cell)     entries by partition of the table
//   entries     ~110                   the same by cell
//   begin       ~15                    where the entries of each cell begin; cells share places
//
// Not thread-safe: one search at a time.
class MeetingSearch {
 public:
  // positions: by vertex id, finite; abc: three ids per face; moved: face indices, ascending, each
  // once. max_edge > 0: about the longest edge; it sets the size of the cells, larger faces are
  // found all the same. Returns the pairs (f, g), f < g, of which at least one moved and that meet
  // (triangle_intersection.h: exact, faces of zero area left out), sorted, until the next call. The
  // same for any executor.
  const std::vector<FacePair>& find(const Packed* positions, const uint32_t* abc, size_t face_count,
                                    const uint32_t* moved, size_t moved_count, float max_edge,
                                    const Executor& executor);

 private:
  // A moved face in one cell, 32 bytes. The box comes along: most entries end at it.
  struct Entry {
    float low[3], high[3];
    uint32_t face;
    uint32_t place;  // of its cell in the table
  };
  struct Cells {
    int32_t low[3], high[3];
  };

  void place_grid(const Packed* positions, const uint32_t* abc, const uint32_t* moved, size_t count,
                  float max_edge, const Executor& executor);
  void fill(const Packed* positions, const uint32_t* abc, const uint32_t* moved, size_t count,
            const Executor& executor);
  void sort_partition(size_t partition);
  void search_block(const Packed* positions, const uint32_t* abc, size_t begin, size_t end,
                    const uint32_t* moved, const uint32_t* moved_end,
                    std::vector<FacePair>& pairs) const;

  // Never falls when x grows; so a point of two boxes lies in cells of both.
  int32_t cell(int axis, float x) const {
    return static_cast<int32_t>((x - origin_[axis]) * per_cell_);
  }
  Cells cells_of(const FaceBox& box) const;
  uint32_t place(int32_t x, int32_t y, int32_t z) const {
    return (static_cast<uint32_t>(x) + static_cast<uint32_t>(y) * stride_[0] +
            static_cast<uint32_t>(z) * stride_[1]) &
           mask_;
  }

  FaceBox moved_box_{};  // of all moved faces: the grid's extent
  float origin_[3] = {0, 0, 0};
  float per_cell_ = 1;           // 1 / size of a cell
  int32_t last_[3] = {0, 0, 0};  // the largest cell index of each axis
  uint32_t stride_[2] = {1, 1};
  uint32_t mask_ = 0;        // the table has mask_ + 1 places, a power of two
  Buffer<uint32_t> counts_;  // [partition][block]: entries, then where they begin
  Buffer<Entry> unsorted_;
  Buffer<Entry> entries_;
  Buffer<uint32_t> begin_;  // per place, and one more
  std::vector<FaceBox> block_boxes_;
  std::vector<std::vector<FacePair>> found_;
  std::vector<FacePair> pairs_;
};

}  // namespace plc
