// A triangle mesh from elsewhere as the engine's own: an initial surface that the caller brings.
#pragma once
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/status.h"

namespace plc {

// given: in mesh space, faces counter-clockwise seen from outside. Replaces what is in the mesh,
// but for delta, which is left to the caller as are the constraints for it (conform.h). Vertices
// without a face are dropped, the others keep their order.
//
// kInvalidData, the mesh unchanged, for all that is not a valid surface (mesh_check.h): no
// faces, out of range, open, not manifold, inconsistently oriented, inside out (walls of
// cavities: outside out), faces of zero area, self-intersecting - or become so by the rounding of
// coordinates to float - or with more vertices or edges at a vertex than ids have room for. One
// line that says what is wrong, how often and where first, in the ids given and at the places of
// `as_given`: three values per vertex as the caller's user knows them; NULL: those of `given`.
// kInvalidArgument for counts below 0 and NULL. The same for any executor.
//
// held: NULL, or a value of patch.h per vertex: it makes the mesh a patch (mesh.h).
// It may be open then; what is nearer than an edge to a border is held. Every border is
// closed by absent vertices, whose faces are no part of the surface, and nobody asks whether it is
// outward.
Status import_mesh(const MeshArrays& given, const Executor& executor, Mesh& mesh,
                   const double* as_given = nullptr, const uint8_t* held = nullptr);

}  // namespace plc
