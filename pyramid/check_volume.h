// Whether a volume can be an image, and how messages write sizes and numbers.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "pyramid/status.h"
#include "pyramid/volume.h"

namespace plc {

inline constexpr int64_t kMaxVoxels = int64_t{1} << 31;  // voxel indices are 32-bit in the kernels
inline constexpr int64_t kMinDim = 2;  // a cell of the interpolation needs two voxels

// kInvalidArgument (no voxels, unknown type) or kInvalidData (dims outside kMinDim .. kMaxVoxels-1,
// kMaxVoxels or more in all, spacing not finite and greater than 0). The voxels are not read.
Status check_volume(const VolumeView& volume);

// "M x N x P voxels"
std::string voxels_text(const std::array<int64_t, 3>& dims);
// As printf's %g with so many digits.
std::string number_text(double value, int digits = 6);

}  // namespace plc
