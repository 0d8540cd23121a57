// The faces around one vertex, and whether they can meet each other.
#pragma once
#include <cstdint>

#include "kernels/ring.h"

namespace plc {

// True only when no two of the faces around v meet elsewhere than in what they share. One pass over
// the ring instead of exact tests of all pairs. Sufficient, not necessary: seen along the sum n of
// the faces' normals, all faces turn counter-clockwise and go around v once, so that the star
// projects one to one along n. Certain in spite of rounding; false where rounding leaves a doubt.
// v is alive; positions by id.
bool star_is_plain(const RingView& rings, const Packed* positions, uint32_t v);

}  // namespace plc
