// Mean and Gaussian curvature at the vertices of a mesh.
// M. Meyer, M. Desbrun, P. Schroeder, A. H. Barr, "Discrete Differential-Geometry Operators for
// Triangulated 2-Manifolds", Visualization and Mathematics III, 2003: the mean curvature normal
// (8), the Gaussian curvature (9), the mixed area of 3.3.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "pyramid/executor.h"

namespace plc {

// mean, gaussian, area: one value per vertex, each NULL where it is not wanted; plc_mesh_curvature
// says what they are. The sign of the mean curvature is that of its normal along the normal of the
// vertex (faces weighted by their angles there): positive where the surface is convex and faces are
// outward. What of the mean curvature normal is tangential is an error of the mesh, not curvature,
// and is left out. A face of no area adds its angles alone.
//
// At most kMaxFaces faces. A gather per vertex, in the order of its corners: the same bits for
// any executor.
void vertex_curvature(const MeshArrays& mesh, const Executor& executor, double* mean,
                      double* gaussian, double* area);

}  // namespace plc
