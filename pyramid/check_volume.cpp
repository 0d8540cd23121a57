#include "pyramid/check_volume.h"

#include <cmath>
#include <cstdio>

namespace plc {

namespace {

// Compared before it is multiplied out: products of three dims may pass 2^63.
bool has_image_dims(const std::array<int64_t, 3>& dims) {
  int64_t voxels = 1;
  for (const int64_t dim : dims) {
    if (dim < kMinDim || dim >= kMaxVoxels) return false;
    voxels *= dim;
    if (voxels >= kMaxVoxels) return false;
  }
  return true;
}

}  // namespace

Status check_volume(const VolumeView& volume) {
  if (volume.voxels == nullptr) {
    return {ErrorCode::kInvalidArgument, "volume: voxels is null, expected the image's data"};
  }
  if (voxel_size(volume.type) == 0) {
    return {
        ErrorCode::kInvalidArgument,
        "volume: voxel type " + std::to_string(static_cast<int>(volume.type)) + " is not known"};
  }
  if (!has_image_dims(volume.dims)) {
    return {ErrorCode::kInvalidData, "image of " + voxels_text(volume.dims) +
                                         ": expected at least 2 on every axis, fewer than 2^31 in "
                                         "all"};
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
