// Leaves small parts and cavities out of an iso-surface.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/start/iso_surface.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"

namespace plc {

// points: of vertices on edges along x, as those of a row follow each other, the points of the
// lattice up to there in its row, less where the surface enters the object; 0 of others. The sum
// over a component is how many points it encloses. What iso_crossings() says of `least`; what stays
// keeps its order. The same for any executor.
void leave_out_small_parts(const Buffer<int32_t>& points, int64_t least, const Executor& executor,
                           Crossings& all);

}  // namespace plc
