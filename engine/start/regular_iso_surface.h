// The iso-surface with vertices about a voxel apart: a quarter of those of iso_surface.h, so that
// little is left to be done before it is as coarse as the mesh. Late bubbles, the initial model of
// figure 23, and the surfaces of masks and labels start from it.
//
// After Treece, Prager and Gee, "Regularised marching tetrahedra" (Computers & Graphics 23, 1999):
// the crossings on the edges of one voxel that is inside are merged into one vertex, on the
// iso-surface, where the surface stays a manifold. They keep crossings apart beforehand, by cases;
// here crossings are merged as long as edges may be contracted, and apart again where the faces
// then meet. In an adaptive mesh crossings across a voxel from each other stay apart, too: they are
// of the two sheets of a part of one voxel.
#pragma once
#include "engine/base/schedule.h"
#include "engine/start/iso_surface.h"

namespace plc {

// As iso_surface(); embedded, with other vertices, and without gaps in the ids.
Status regular_iso_surface(const ImageObject& object, const LatticeValues& values,
                           const Schedule& schedule, Mesh& mesh);

}  // namespace plc
