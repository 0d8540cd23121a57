#include "tools/blocks/block_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plc::tools {

namespace {

constexpr int64_t kParts = 3;  // cells of a block on an axis

// visit(x, y, z) of a box of numbers, both ends within.
template <typename Visit>
void visit_box(const Int3& low, const Int3& high, const Visit& visit) {
  for (int64_t z = low[2]; z <= high[2]; ++z) {
    for (int64_t y = low[1]; y <= high[1]; ++y) {
      for (int64_t x = low[0]; x <= high[0]; ++x) visit(Int3{x, y, z});
    }
  }
}

std::vector<Int3> box_of(const Int3& low, const Int3& high) {
  std::vector<Int3> all;
  visit_box(low, high, [&](const Int3& at) { all.push_back(at); });
  return all;
}

}  // namespace

BlockGrid::BlockGrid(const Int3& dims, int64_t side, int64_t margin)
    : dims_(dims), side_(side), margin_(margin) {
  // What is left over at the end of an axis is a block of its own only where it is half of one.
  for (size_t a = 0; a < 3; ++a) {
    blocks_[a] = std::max<int64_t>(1, (dims[a] + side / 2) / side);
  }
}

Int3 BlockGrid::block_at(int64_t index) const {
  return {index % blocks_[0], index / blocks_[0] % blocks_[1], index / blocks_[0] / blocks_[1]};
}

int64_t BlockGrid::index_of(const Int3& block) const {
  return (block[2] * blocks_[1] + block[1]) * blocks_[0] + block[0];
}

std::string BlockGrid::name_of(const Int3& block) {
  return std::to_string(block[0]) + "-" + std::to_string(block[1]) + "-" + std::to_string(block[2]);
}

int BlockGrid::colour_of(const Int3& block) {
  return static_cast<int>((block[0] & 1) | (block[1] & 1) << 1 | (block[2] & 1) << 2);
}

std::vector<int64_t> BlockGrid::blocks_of_colour(int colour) const {
  std::vector<int64_t> found;
  for (int64_t index = 0; index < block_count(); ++index) {
    if (colour_of(block_at(index)) == colour) found.push_back(index);
  }
  return found;
}

Int3 BlockGrid::cell_of(const std::array<double, 3>& voxel) const {
  Int3 cell{};
  for (size_t a = 0; a < 3; ++a) {
    const auto side = static_cast<double>(side_);
    const double within = std::clamp(voxel[a], 0.0, static_cast<double>(dims_[a]));
    const int64_t block =
        std::clamp(static_cast<int64_t>(std::floor(within / side)), int64_t{0}, blocks_[a] - 1);
    const double from_low = within - static_cast<double>(block * side_);
    const bool last = block + 1 == blocks_[a];
    int64_t part = 1;
    if (from_low < static_cast<double>(margin_)) part = 0;
    if (!last && from_low >= static_cast<double>(side_ - margin_)) part = 2;
    cell[a] = kParts * block + part;
  }
  return cell;
}

Int3 BlockGrid::block_of_cell(const Int3& cell) {
  return {cell[0] / kParts, cell[1] / kParts, cell[2] / kParts};
}

bool BlockGrid::Window::contains(const Int3& cell) const {
  for (size_t a = 0; a < 3; ++a) {
    if (cell[a] < low[a] || cell[a] > high[a]) return false;
  }
  return true;
}

Int3 BlockGrid::Window::nearest(const Int3& cell) const {
  Int3 at{};
  for (size_t a = 0; a < 3; ++a) at[a] = std::clamp(cell[a], low[a], high[a]);
  return at;
}

BlockGrid::Window BlockGrid::window_of(const Int3& block) const {
  Window window;
  for (size_t a = 0; a < 3; ++a) {
    window.low[a] = std::max<int64_t>(0, kParts * block[a] - 1);
    window.high[a] = std::min(kParts * blocks_[a] - 1, kParts * (block[a] + 1));
  }
  return window;
}

std::vector<Int3> BlockGrid::cells_of(const Window& window) const {
  return box_of(window.low, window.high);
}

std::vector<Int3> BlockGrid::own_cells(const Int3& block) const {
  const Int3 low{kParts * block[0], kParts * block[1], kParts * block[2]};
  return box_of(low, {low[0] + kParts - 1, low[1] + kParts - 1, low[2] + kParts - 1});
}

void BlockGrid::bounds_of(const Window& window, std::array<double, 3>& low,
                          std::array<double, 3>& high) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  for (size_t a = 0; a < 3; ++a) {
    const auto start = [&](int64_t cell) {
      const int64_t block = cell / kParts, part = cell % kParts;
      const int64_t within = part == 0 ? 0 : part == 1 ? margin_ : side_ - margin_;
      return static_cast<double>(block * side_ + within);
    };
    low[a] = window.low[a] == 0 ? -kFar : start(window.low[a]);
    // The last block on an axis has no third part.
    high[a] = window.high[a] + 2 >= kParts * blocks_[a] ? kFar : start(window.high[a] + 1);
  }
}

BlockGrid::Writer BlockGrid::writer_of(const Int3& cell, int before) const {
  const Int3 own = block_of_cell(cell);
  Int3 low = own, high = own;
  for (size_t a = 0; a < 3; ++a) {
    const int64_t part = cell[a] % kParts;
    if (part == 0) low[a] = std::max<int64_t>(0, own[a] - 1);
    if (part == kParts - 1) high[a] = std::min(blocks_[a] - 1, own[a] + 1);
  }
  Writer last{-1, own};
  visit_box(low, high, [&](const Int3& block) {
    // The last step of this colour before `before`.
    const int colour = colour_of(block);
    const int step = before - 1 - ((before - 1 - colour) % kColours + kColours) % kColours;
    if (step > last.step) last = {step, block};
  });
  return last;
}

}  // namespace plc::tools
