// How a large image is divided: into blocks, of which each is a task on every level, and into
// cells, of which each belongs to one task at a time.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace plc::tools {

using Int3 = std::array<int64_t, 3>;

// A block is a cube of `side` voxels. On each axis it is cut into three: `margin` at either end,
// and what is between. These are its 27 cells. The window of a block is its own cells and those of
// its neighbours that touch it: what a task reads, changes and writes. Blocks whose numbers differ
// by a multiple of two on every axis have a colour in common; their windows have no cell in common,
// so that all tasks of one colour can run at a time. Eight colours, one after the other, make a
// level.
//
// A cell that a window holds is written by its task, so that the cell is where the last one of
// these tasks has put it: nothing has to be looked up.
class BlockGrid {
 public:
  // dims: voxels; side > 2 * margin > 0.
  BlockGrid() = default;
  BlockGrid(const Int3& dims, int64_t side, int64_t margin);

  static constexpr int kColours = 8;

  const Int3& dims() const { return dims_; }
  int64_t side() const { return side_; }
  int64_t margin() const { return margin_; }
  const Int3& blocks() const { return blocks_; }
  int64_t block_count() const { return blocks_[0] * blocks_[1] * blocks_[2]; }
  Int3 block_at(int64_t index) const;
  int64_t index_of(const Int3& block) const;
  // "2-0-11": for names of files.
  static std::string name_of(const Int3& block);
  static int colour_of(const Int3& block);
  std::vector<int64_t> blocks_of_colour(int colour) const;

  // Cells are numbered on each axis from 0, three to a block.
  Int3 cell_of(const std::array<double, 3>& voxel) const;
  static Int3 block_of_cell(const Int3& cell);
  // First and last cell of a window, both within.
  struct Window {
    Int3 low, high;
    bool contains(const Int3& cell) const;
    Int3 nearest(const Int3& cell) const;
  };
  Window window_of(const Int3& block) const;
  std::vector<Int3> cells_of(const Window& window) const;
  std::vector<Int3> own_cells(const Int3& block) const;
  // In voxels, how far the window reaches; beyond the image where it ends with it.
  void bounds_of(const Window& window, std::array<double, 3>& low,
                 std::array<double, 3>& high) const;

  // Steps are numbered from 0: eight for each level, coarse to fine. The task that has last written
  // a cell before step `before`: its step and block; step -1: the coarse levels have.
  struct Writer {
    int step;
    Int3 block;
  };
  Writer writer_of(const Int3& cell, int before) const;

 private:
  Int3 dims_{}, blocks_{};
  int64_t side_ = 0, margin_ = 0;
};

}  // namespace plc::tools
