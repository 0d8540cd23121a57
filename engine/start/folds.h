// Where a surface bends and the image, by which an adaptive mesh has its sizes, does not.
#pragma once
#include "engine/mesh/mesh.h"
#include "engine/start/half_edges.h"
#include "engine/start/voxel_set.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"

namespace plc {

// The size that an adaptive mesh is to have at most, in delta, where it has missed a voxel or is
// folded at it: less where the full image is thin there.
float late_size(const Mesh& mesh, const Voxel& voxel);

// Puts the voxels of those vertices into `folds`, which is of the image's voxels or of none yet,
// whose size is above that and the finest, and one of whose faces turns from their normal by more
// than kFoldCosine: of the border of a hole that a coarser level has torn into a plate, of
// tips and ridges that the image has not. False where there are none. The mesh is adaptive.
bool find_folds(const Mesh& mesh, VoxelSet& folds);

// The same of the vertices of the surface that the mesh is to start from, but only where the full
// image is thin: the rims of holes and of strips, which would be cut to pieces by edges that are
// long for them before anything has moved. Where noise is above kThinNoise it makes such rims, and
// none are found. xyz: its vertices, in mesh space. The same for any executor.
bool find_folds(const Mesh& mesh, const HalfEdges& surface, const Buffer<float>& xyz,
                const Executor& executor, VoxelSet& folds);

}  // namespace plc
