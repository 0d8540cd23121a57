// A surface that is much finer than the sizes of an adaptive mesh, with as few vertices as those
// ask for.
#pragma once
#include <functional>

#include "engine/base/schedule.h"
#include "engine/mesh/mesh.h"
#include "engine/start/iso_surface.h"
#include "engine/start/start_hooks.h"
#include "pyramid/status.h"

namespace plc {

// Replaces what is in the mesh. Vertices that stay are about a size apart, so that edges are about
// as long as kMeanEdge has them; all are where they were. What is nearer to one that stays is
// merged into it, where the surface stays a manifold, no edge violates (2) and no face turns by
// more than 60 degrees. No guard is asked, which is what makes it faster than conform.h: faces that
// meet are looked for when a block of the surface is done, and where there are any nothing is
// merged at their corners.
//
// The blocks of a grid are thinned out at once, each by itself, then those of another grid, in
// which lies within a block what was at a border; so the same bits for any executor.
//
// make(surface) makes the surface, always the same: closed, oriented, a manifold, embedded, in mesh
// space; every vertex has a face. It is not kept, and made once more where faces of different
// blocks meet. The result is embedded, too, without gaps in its ids, which lie along a Morton
// curve. mesh.sizing is not null; its sizes may be lowered by before_thinning. Throws
// std::bad_alloc; kCancelled, with the mesh spoilt, where go_on, asked after every grid, says so;
// what make() fails with.
using MakeCrossings = std::function<Status(Crossings& surface)>;
Status thin_out(const MakeCrossings& make, const Schedule& schedule, const StartHooks& hooks,
                Mesh& mesh);

}  // namespace plc
