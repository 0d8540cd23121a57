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

// Bytes that the machine has left; 0 where the system does not say.
uint64_t available_memory();

// Throws Failure where the machine has not `bytes` left.
void require_memory(const std::string& path, uint64_t bytes);

// Before so many bytes of voxels are unpacked or read, once it is known that the file can hold
// them: a reader apart gets time and memory for that.
void allow_for(uint64_t bytes);

// Defaults of plc_image_defaults, the given type and dims, and room for the voxels.
LoadedVolume make_volume(const std::string& path, plc_voxel_type type, const int64_t dims[3]);

// In lower case: ".nii.gz" is one; "" where there is none.
std::string path_suffix(const std::string& path);

}  // namespace plc::tools
