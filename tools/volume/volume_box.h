// A region of a volume: a box of its voxels.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "tools/volume/volume_io.h"

namespace plc::tools {

// Voxel indices, both ends within.
struct VoxelBox {
  std::array<int64_t, 3> low, high;
};

// Where the box lies; of an image without voxels. `path` is for messages. Throws Failure where the
// box reaches beyond the volume or has fewer than two voxels along an axis.
plc_image image_of_box(const std::string& path, const plc_image& whole, const VoxelBox& box);

// The voxels of the box alone, where they lie. Throws Failure.
LoadedVolume cut_out(const std::string& path, const LoadedVolume& volume, const VoxelBox& box);

}  // namespace plc::tools
