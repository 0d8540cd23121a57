// The iso-surface with about as many vertices as the mesh is to have, so that little is left to be
// done. Late bubbles, the initial model of figure 23, and the surfaces of masks and labels start
// from it.
//
// In an adaptive mesh the crossings of iso_surface.h are thinned out to the sizes (thinning.h). In
// a uniform one, whose edges are about a voxel long, those on the edges of one voxel that is inside
// are merged into one vertex, on the iso-surface, where the surface stays a manifold: a quarter of
// the vertices. After Treece, Prager and Gee, "Regularised marching tetrahedra" (Computers &
// Graphics 23, 1999). They keep crossings apart beforehand, by cases; here crossings are merged as
// long as edges may be contracted, and apart again where the faces then meet.
#pragma once
#include "engine/base/schedule.h"
#include "engine/start/iso_surface.h"
#include "engine/start/start_hooks.h"

namespace plc {

// As iso_surface(); embedded, with other vertices, and without gaps in the ids. least: in an
// adaptive mesh as iso_crossings() has it, in others 0. Hooks are for adaptive meshes. kCancelled,
// with the mesh spoilt, where go_on, asked between parts of the work, says so.
Status regular_iso_surface(const ImageObject& object, const LatticeValues& values,
                           const Schedule& schedule, Mesh& mesh, int64_t least = 0,
                           const StartHooks& hooks = {});

}  // namespace plc
