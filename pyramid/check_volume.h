// Whether a volume can be an image, and how messages write sizes and numbers.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "pyramid/status.h"
#include "pyramid/volume.h"

namespace plc {

// Of images whose voxels are floats, and of gradients: their kernels number voxels by 32 bits.
inline constexpr int64_t kMaxVoxels = int64_t{1} << 31;
// Of volumes that are read where they lie: their kernels number rows by 32 bits.
inline constexpr int64_t kMaxPlane = int64_t{1} << 31;  // of voxels, across every axis
inline constexpr int64_t kMaxVolume = int64_t{1} << 40;
inline constexpr int64_t kMinDim = 2;  // a cell of the interpolation needs two voxels

// kInvalidArgument (no voxels, unknown type) or kInvalidData (dims below kMinDim, not
// is_volume_size(), spacing not finite and greater than 0). The voxels are not read.
Status check_volume(const VolumeView& volume);
// Whether all products of two dims are below kMaxPlane, and that of all is below kMaxVolume.
bool is_volume_size(const std::array<int64_t, 3>& dims);

// "M x N x P voxels"
std::string voxels_text(const std::array<int64_t, 3>& dims);
// As printf's %g with so many digits.
std::string number_text(double value, int digits = 6);

}  // namespace plc
