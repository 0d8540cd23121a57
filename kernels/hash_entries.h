// Which entries of the spatial hash may lie within a box: by coarse places that lie beside them.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "kernels/simd.h"

namespace plc {

// Where a vertex is, in 9 bits for each axis: quanta modulo 512. Fields of 10 bits, the highest of
// each 0: it stops what is borrowed from it.
using CoarsePlace = uint32_t;
inline constexpr int32_t kPlacePeriod = 512;
inline constexpr uint32_t kPlaceGuards = 1U << 9U | 1U << 19U | 1U << 29U;

inline CoarsePlace coarse_place(int32_t x, int32_t y, int32_t z) {
  const auto field = [](int32_t q) { return static_cast<uint32_t>(q) % uint32_t{kPlacePeriod}; };
  return field(x) | field(y) << 10U | field(z) << 20U;
}

// A box of quanta: from `low`, so many more along each axis.
struct CoarseBox {
  CoarsePlace low, extent;
};
inline CoarseBox coarse_box(const int32_t* low, const int32_t* high) {
  const auto extent = [&](int axis) {
    return std::min(high[axis] - low[axis], kPlacePeriod - 1);  // all of them
  };
  return {coarse_place(low[0], low[1], low[2]), coarse_place(extent(0), extent(1), extent(2))};
}
// False where a vertex at this place does not lie within the box.
inline bool may_be_within(CoarsePlace place, const CoarseBox& box) {
  const uint32_t from_low = ((place | kPlaceGuards) - box.low) & ~kPlaceGuards;
  return (((box.extent | kPlaceGuards) - from_low) & kPlaceGuards) == kPlaceGuards;
}

namespace kernels {

// Entries first .. last-1.
struct EntryRun {
  uint32_t first, last;
};

// Writes the ids of the entries of these runs whose place may be within the box, in order, and
// returns how many. ids and places may be read up to kRingLanes beyond the last entry; out: room
// for all entries of the runs and kRingLanes more. The same for any `simd`.
uint32_t entries_within(SimdTarget simd, const uint32_t* ids, const CoarsePlace* places,
                        const EntryRun* runs, size_t count, const CoarseBox& box, uint32_t* out);

}  // namespace kernels
}  // namespace plc
