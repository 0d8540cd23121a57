// Where a surface bends and the image, by which an adaptive mesh has its sizes, does not.
#pragma once
#include "engine/mesh/mesh.h"
#include "engine/start/voxel_set.h"
#include "kernels/image.h"

namespace plc {

// Puts the voxels of those vertices into `folds`, which is of the image's voxels or of none yet,
// whose size is above kLateSize and the finest, and one of whose faces turns from their normal by
// more than kFoldCosine: of the border of a hole that a coarser level has torn into a plate, of
// tips and ridges that the image has not. False where there are none. The mesh is adaptive.
bool find_folds(const Mesh& mesh, const ImageView& image, VoxelSet& folds);

}  // namespace plc
