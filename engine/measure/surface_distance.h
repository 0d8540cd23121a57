// Distances from a mesh to the nearest points of another one's faces.
#pragma once
#include "engine/base/mesh_arrays.h"
#include "pyramid/executor.h"

namespace plc {

// As plc_distances has them.
struct SurfaceDistances {
  double mean, rms, max;
  double vertex_mean, vertex_max;
};

// plc_mesh_distance says what is computed. `other` has a face; distance: one value per vertex of
// mesh, or NULL. Five queries per face of mesh, of which each takes the logarithm of the other's
// faces where the meshes are near each other. The same bits for any executor.
SurfaceDistances surface_distances(const MeshArrays& mesh, const MeshArrays& other,
                                   const Executor& executor, double* distance);

}  // namespace plc
