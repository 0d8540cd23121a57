#include "pyramid/check_volume.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace plc {

// Products of two are looked at before those of three, which may pass 2^63.
bool is_volume_size(const std::array<int64_t, 3>& dims) {
  const auto [m, n, p] = dims;
  for (const int64_t dim : dims) {
    if (dim < 1 || dim >= kMaxPlane) return false;
  }
  return m * n < kMaxPlane && n * p < kMaxPlane && p * m < kMaxPlane && m * n * p < kMaxVolume;
}

Status check_volume(const VolumeView& volume) {
  if (volume.voxels == nullptr && volume.bricks == nullptr) {
    return {ErrorCode::kInvalidArgument, "volume: voxels is null, expected the image's data"};
  }
  if (voxel_size(volume.type) == 0) {
    return {
        ErrorCode::kInvalidArgument,
        "volume: voxel type " + std::to_string(static_cast<int>(volume.type)) + " is not known"};
  }
  if (*std::min_element(volume.dims.begin(), volume.dims.end()) < kMinDim ||
      !is_volume_size(volume.dims)) {
    return {ErrorCode::kInvalidData, "image of " + voxels_text(volume.dims) +
                                         ": expected at least 2 on every axis, fewer than 2^31 in "
                                         "a plane, fewer than 2^40 in all"};
  }
  for (const double spacing : volume.spacing) {
    if (std::isfinite(spacing) && spacing > 0.0) continue;
    return {ErrorCode::kInvalidData, "spacing " + number_text(volume.spacing[0]) + " x " +
                                         number_text(volume.spacing[1]) + " x " +
                                         number_text(volume.spacing[2]) +
                                         " mm: expected finite sizes greater than 0"};
  }
  return {};
}

std::string voxels_text(const std::array<int64_t, 3>& dims) {
  return std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " +
         std::to_string(dims[2]) + " voxels";
}

std::string number_text(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

}  // namespace plc
