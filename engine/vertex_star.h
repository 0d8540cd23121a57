// The faces around one vertex, and whether they can meet each other.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/vec3.h"
#include "kernels/ring.h"

namespace plc {

// True only when no two of the faces around v meet elsewhere than in what they share. One pass over
// the ring instead of exact tests of all pairs. Sufficient, not necessary: seen along the sum n of
// the faces' normals, all faces turn counter-clockwise and go around v once, so that the star
// projects one to one along n. Certain in spite of rounding; false where rounding leaves a doubt.
// Neither has one of them a zero area then. v is alive; positions by id.
bool star_is_plain(const RingView& rings, const Packed* positions, uint32_t v);
// Of the faces (centre, ring[k], ring[k + 1]) around a point.
bool fan_is_plain(const Vec3& centre, const Vec3* ring, size_t count);

}  // namespace plc
