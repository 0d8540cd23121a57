#include "engine/start/thinning_grid.h"

#include <algorithm>
#include <numeric>

#include "engine/base/blocks.h"

namespace plc {

namespace {

constexpr size_t kVertices = 4096;  // of a task

}  // namespace

ThinningGrid::ThinningGrid(const Buffer<SizedPlace>& places, const HalfEdges& surface,
                           const Box3& bounds, float side, float shift, const Executor& executor) {
  const auto along = [side, shift](float x, float low) {
    return static_cast<uint32_t>((x - low) / side + shift);
  };
  const float *const low = bounds.low, *const high = bounds.high;
  const uint32_t columns = along(high[0], low[0]) + 1, rows = along(high[1], low[1]) + 1;
  block_.resize_uninitialized(places.size());
  run_blocks(executor, places.size(), kVertices, [&](size_t, size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) {
      const Vec3 p = places[v].at;
      block_[v] = (along(p.z, low[2]) * rows + along(p.y, low[1])) * columns + along(p.x, low[0]);
    }
  });
  begin_.assign(size_t{columns} * rows * (along(high[2], low[2]) + 1) + 1, 0);
  for (uint32_t v = 0; v < block_.size(); ++v) {
    if (surface.alive(v)) ++begin_[block_[v] + size_t{1}];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  ids_.resize_uninitialized(begin_.back());
  Vector<size_t> end = begin_;
  for (uint32_t v = 0; v < block_.size(); ++v) {
    if (surface.alive(v)) ids_[end[block_[v]]++] = v;
  }
}

Box3 bounds_of(const Buffer<SizedPlace>& places) {
  const Vec3 first = places[0].at;
  Box3 b{{first.x, first.y, first.z}, {first.x, first.y, first.z}};
  for (const SizedPlace& place : places) {
    const float at[3] = {place.at.x, place.at.y, place.at.z};
    for (size_t a = 0; a < 3; ++a) {
      b.low[a] = std::min(b.low[a], at[a]);
      b.high[a] = std::max(b.high[a], at[a]);
    }
  }
  return b;
}

}  // namespace plc
