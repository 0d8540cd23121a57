// The one order in which the kernels add up a range.
#pragma once
#include "kernels/ring.h"

namespace plc::kernels {

// A sum over a range has kRingLanes accumulators whatever the vector width: accumulator l adds the
// vertices with v % kRingLanes == l from the first to the last. Then they are added pairwise:
//   l += l + 8 for l < 8;  l += l + 4 for l < 4;  l += l + 2 for l < 2;  0 += 1.
inline double add_lanes(double (&lane)[kRingLanes]) {
  for (uint32_t half = kRingLanes / 2; half != 0; half /= 2) {
    for (uint32_t l = 0; l < half; ++l) lane[l] += lane[l + half];
  }
  return lane[0];
}

}  // namespace plc::kernels
