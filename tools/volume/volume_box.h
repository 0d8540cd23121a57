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

// The voxels of the box alone, where they lie. `path` is for messages. Throws Failure where the box
// reaches beyond the volume or has fewer than two voxels along an axis.
LoadedVolume cut_out(const std::string& path, const LoadedVolume& volume, const VoxelBox& box);

}  // namespace plc::tools
