// Checks and allocation shared by everything that makes a volume.
#pragma once
#include <cstdint>
#include <string>

#include "tools/volume/volume_io.h"

namespace plc::tools {

size_t voxel_size(plc_voxel_type type);

// "256 x 256 x 108"
std::string dims_text(const int64_t dims[3]);

// The number of voxels. Throws Failure unless every dimension is >= 2 and dims * 8 bytes fit 63
// bit.
int64_t checked_voxel_count(const std::string& path, const int64_t dims[3]);

// Defaults of plc_image_defaults, the given type and dims, and room for the voxels.
LoadedVolume make_volume(const std::string& path, plc_voxel_type type, const int64_t dims[3]);

}  // namespace plc::tools
