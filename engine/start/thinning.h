// A surface that is much finer than the sizes of an adaptive mesh, with as few vertices as those
// ask for.
#pragma once
#include "engine/base/schedule.h"
#include "engine/mesh/mesh.h"

namespace plc {

// Vertices that stay are about a size apart, so that edges are about as long as kMeanEdge has them;
// all are where they were. What is nearer to one that stays is merged into it, in the order of the
// ids, where the surface stays a manifold, no edge violates (2) and no face turns by more than 60
// degrees. No guard is asked, which is what makes it faster than conform.h: faces that meet are
// looked for at the end, and what was merged around them stays as it was.
//
// On entry embedded, without gaps in the ids; on return too, and the ids lie along a Morton curve.
// mesh.sizing is not null. The same bits for any executor. Throws std::bad_alloc.
void thin_out(Mesh& mesh, const Schedule& schedule);

}  // namespace plc
