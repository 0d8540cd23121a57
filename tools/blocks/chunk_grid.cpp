#include "tools/blocks/chunk_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/file/failure.h"

namespace plc::tools {

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

bool z_before(const Int3& l, const Int3& r) {
  // The axis whose numbers differ in the highest bit decides; of several z, then y.
  size_t axis = 2;
  for (const size_t other : {size_t{1}, size_t{0}}) {
    const int64_t a = l[axis] ^ r[axis], b = l[other] ^ r[other];
    if (a < b && a < (a ^ b)) axis = other;
  }
  return l[axis] < r[axis];
}

ChunkGrid::ChunkGrid(const BlockPlan& plan, int lods) {
  const BlockGrid& grid = plan.grid;
  finest_ = static_cast<double>(grid.side()) / 2;
  while (finest_ > kFinestChunk) finest_ /= 2, ++box_lod_;

  const int64_t longest = *std::max_element(grid.dims().begin(), grid.dims().end());
  int most = 1;
  while (chunk(most - 1) < static_cast<double>(longest + 2 * kRim)) ++most;
  if (lods > most) {
    throw Failure{"--lods " + std::to_string(lods) + ": at most " + std::to_string(most) +
                  ", which end with a single chunk"};
  }
  lods_ = lods > 0 ? lods : most;

  // A box needs no cells beyond the margins of its neighbours' where this is met; that it has a
  // level of detail above 0 is worth reading more.
  reach_ = plan.band() / (kHeldRings + 1);
  const auto halo = [&](int lod) { return 2 * reach_ + (lod > 0 ? cluster(lod) : 0); };
  near_ = lods_ > 1 ? 1 : 0;
  while (near_ > 0 && near_ < lods_ - 1 && near_ < box_lod_ &&
         halo(near_ + 1) + static_cast<double>(kRim) <= static_cast<double>(grid.margin())) {
    ++near_;
  }
  halo_ = halo(near_);

  Int3 last{};
  for (size_t a = 0; a < 3; ++a) {
    const int64_t count = 3 * grid.blocks()[a];
    for (int64_t cell = 0; cell < count; ++cell) {
      Place low{}, high{};
      grid.bounds_of({{cell, cell, cell}, {cell, cell, cell}}, low, high);
      // The last block has two cells: the second one goes to the end.
      cells_[a].push_back({low[a], cell + 2 < count ? high[a] : kFar});
    }
    const double width = static_cast<double>(grid.dims()[a] + 2 * kRim);
    last[a] = static_cast<int64_t>(std::ceil(width / box_side())) - 1;
    end_[a] = origin() + static_cast<double>(last[a] + 1) * box_side();
  }
  for (int64_t z = 0; z <= last[2]; ++z) {
    for (int64_t y = 0; y <= last[1]; ++y) {
      for (int64_t x = 0; x <= last[0]; ++x) boxes_.push_back({x, y, z});
    }
  }
  std::sort(boxes_.begin(), boxes_.end(), ZOrder());
}

double ChunkGrid::chunk(int lod) const {
  return std::ldexp(finest_, lod);
}

Int3 ChunkGrid::chunks(int lod) const {
  Int3 count{};
  for (size_t a = 0; a < 3; ++a) {
    count[a] = static_cast<int64_t>(std::ceil((end_[a] - origin()) / chunk(lod)));
  }
  return count;
}

// A face of a box has a corner nearer to it than reach(). The clusters of such a face's corners are
// within a cluster's width and reach() of the box, and a face with a corner in one of them is in a
// cell that is at most reach() farther away.
std::vector<Int3> ChunkGrid::cells_around(const Int3& box) const {
  std::array<std::vector<int64_t>, 3> found;
  for (size_t a = 0; a < 3; ++a) {
    const double low = origin() + static_cast<double>(box[a]) * box_side();
    for (size_t cell = 0; cell < cells_[a].size(); ++cell) {
      const Span& span = cells_[a][cell];
      if (span.high >= low - halo_ && span.low <= low + box_side() + halo_) {
        found[a].push_back(static_cast<int64_t>(cell));
      }
    }
  }
  std::vector<Int3> cells;
  for (const int64_t z : found[2]) {
    for (const int64_t y : found[1]) {
      for (const int64_t x : found[0]) cells.push_back({x, y, z});
    }
  }
  return cells;
}

bool ChunkGrid::holds(const Int3& cell, const BlockCell& faces) const {
  for (size_t a = 0; a < 3; ++a) {
    const Span& span = cells_[a][static_cast<size_t>(cell[a])];
    for (size_t v = 0; v < faces.ids.size(); ++v) {
      const double x = faces.xyz[3 * v + a];
      if (x < span.low - reach_ || x > span.high + reach_ || x < origin() || x >= end_[a]) {
        return false;
      }
    }
    for (size_t f = 0; f < faces.abc.size(); f += 3) {
      const auto at = [&](size_t k) { return faces.xyz[3 * size_t{faces.abc[f + k]} + a]; };
      const auto [low, high] = std::minmax({at(0), at(1), at(2)});
      if (high - low > reach_) return false;
    }
  }
  return true;
}

}  // namespace plc::tools
