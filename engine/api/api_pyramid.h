// From a volume and parameters to the pyramid that surfaces evolve in.
#pragma once
#include <memory>

#include "engine/api/handles.h"

namespace plc {

// kInvalidData where voxels are NaN or infinite.
Status check_range(const VoxelRange& range);

// Everything before the evolution: range, window, images, iso-values. `parameters`: checked.
Status build(const std::shared_ptr<const VolumeData>& volume, const plc_parameters& parameters,
             PyramidData& pyramid);

// A pyramid whose levels borrow the values of another, which must outlive it.
Pyramid borrowed(const Pyramid& pyramid);

// Where voxel (0,0,0) of level h lies: the images of all levels fill the same box.
std::array<double, 3> level_origin(const PyramidData& pyramid, int h);

}  // namespace plc
