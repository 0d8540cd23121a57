// The strip of triangles that joins two closed polygons (figure 4b).
#pragma once
#include <cstdint>

#include "engine/base/vec3.h"
#include "pyramid/memory.h"

namespace plc {

// One rung of a strip: polygon corner p[i] is joined to q[j].
struct Rung {
  uint32_t i, j;
};

// The rungs of the shortest strip (least sum of rung lengths) between p, walked forwards, and q,
// walked backwards, over all starts; p.size() + q.size() rungs, each a different edge. From one
// rung to the next either i grows by one or j falls by one, cyclically; the last leads to the
// first. Both polygons have at least 3 corners.
Vector<Rung> shortest_strip(const Vector<Vec3>& p, const Vector<Vec3>& q);

}  // namespace plc
