// Any closed surface made one of the model: the constraints (1)-(3) for delta, without forces.
#pragma once
#include <cstdint>

#include "engine/base/go_on.h"
#include "engine/base/schedule.h"
#include "engine/base/statistics.h"
#include "engine/mesh/mesh.h"
#include "pyramid/status.h"

namespace plc {

// Passes of figure 9 over all vertices, at most, at one delta. Noise was seen to take 7, anything
// smooth 3.
inline constexpr int kConformPasses = 20;

// By the model's own transformations and nothing else:
//   1. creations on the longest edge until none violates (2): the geometry stays, and faces come
//      within the reach of the guards (kFaceReach). Faces that would meet, in single precision, are
//      left whole, and the guards look farther;
//   2. where all edges are far below delta: figure 9 for a delta that fits them, then for sqrt 3
//      times that and so on. At the full delta at once the guards would look at the faces of a
//      hundred vertices for every deletion;
//   3. figure 9 over all vertices until a pass changes nothing, or in an adaptive mesh, whose sizes
//      are kept while it moves, hardly anything, and on the full image without (3), which is not
//      asked for as early there (kFirstPairs).
//
// On entry the mesh is closed, oriented and embedded (mesh_import.h, iso_surface.h), and meets none
// of its obstacles, which it does not on return either; delta > 0 in mesh units. On return it is
// closed, oriented, embedded - tested exactly, on all faces - and at rest, with ids along a Morton
// curve, mesh.delta = delta, every vertex due for a check. counts grows by what was done. The same
// bits for any number of threads.
//
// Promised is the embedding, no more. (1) and (2) hold but where the guards refuse what an edge
// asks for: 1 edge in 500,000 on random images violated (1), none (2). (3): a few pairs stay where
// a sheet was cut (14 in 3,900 vertices of a noisy chain) until forces part them. Not kept: the
// topology - parts thinner than (3) are cut or joined, components of a few delta vanish, as in any
// iteration - and details below delta: deletions merge vertices at mid-points, which rounds corners
// off. Faces that need no operation stay as they are.
//
// Errors, with the mesh spoilt: kInvalidData when nothing is left - then it has no vertices - or
// faces are so thin that rounding makes them meet when divided, and the guards refuse it, too;
// kOutOfMemory for too many vertices; kCancelled where go_on, asked after every pass, says so;
// kInternal when the result is not embedded; throws std::bad_alloc.
Status conform(Mesh& mesh, double delta, const Schedule& schedule, OperationCounts& counts,
               const GoOn& go_on = {});

}  // namespace plc
