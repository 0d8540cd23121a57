// Voxels that hang together by their faces.
#pragma once
#include <algorithm>
#include <cstddef>

#include "engine/start/voxel_set.h"
#include "pyramid/memory.h"

namespace plc {

// Whether a voxel is one of `least` or more that are joined by faces; has(voxel) tells which there
// are, the first among them. What touches by an edge or a corner alone is as good as apart: noise
// does. Takes time with the square of `least`.
template <typename Has>
bool is_joined(const Voxel& voxel, size_t least, const Has& has) {
  Vector<Voxel> part{voxel};
  for (size_t i = 0; i < part.size() && part.size() < least; ++i) {
    for (size_t axis = 0; axis < 3; ++axis) {
      for (const int32_t step : {-1, 1}) {
        Voxel beside = part[i];
        beside[axis] += step;
        const bool is_new = std::find(part.begin(), part.end(), beside) == part.end();
        if (is_new && has(beside)) part.push_back(beside);
      }
    }
  }
  return part.size() >= least;
}

}  // namespace plc
