// What is near a vertex, or near it and turned away: constraint (3) and the motion guard.
#pragma once
#include <cstdint>

#include "kernels/simd.h"

namespace plc::kernels {

// Places and unit normals around, each stream padded to a multiple of kRingLanes with anything.
struct NearbyView {
  const float *x, *y, *z;
  const float *nx, *ny, *nz;
  uint32_t count;
};

// Those with |place - p|^2 < near_squared, or with |place - p|^2 <= far_squared and
// normal . n <= most. near_squared <= far_squared.
struct NearbyQuery {
  float x, y, z;
  float nx, ny, nz;
  float near_squared, far_squared, most;
};

// Writes the indices of what the query asks for, in ascending order, and returns how many. hits:
// room for view.count. Bits do not depend on `simd`: sums go from x to z.
uint32_t near_or_turned(SimdTarget simd, const NearbyView& view, const NearbyQuery& query,
                        uint32_t* hits);

}  // namespace plc::kernels
