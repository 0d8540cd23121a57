#include "tools/volume/volume_box.h"

#include <algorithm>
#include <cstring>

#include "tools/file/failure.h"
#include "tools/volume/volume_frame.h"
#include "tools/volume/volume_io_memory.h"

namespace plc::tools {

namespace {

std::string text_of(const VoxelBox& box) {
  std::string text;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (axis > 0) text += ',';
    text += std::to_string(box.low[axis]);
    text += ',';
    text += std::to_string(box.high[axis]);
  }
  return text;
}

}  // namespace

plc_image image_of_box(const std::string& path, const plc_image& whole, const VoxelBox& box) {
  plc_image part = whole;
  part.voxels = nullptr;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (box.low[axis] < 0 || box.high[axis] >= whole.dims[axis] ||
        box.high[axis] <= box.low[axis]) {
      throw Failure{path + ": the box " + text_of(box) + " is not two voxels or more along each " +
                    "axis of its " + dims_text(whole.dims)};
    }
    part.dims[axis] = box.high[axis] - box.low[axis] + 1;
  }
  const Place origin =
      lps_of(whole, {static_cast<double>(box.low[0]), static_cast<double>(box.low[1]),
                     static_cast<double>(box.low[2])});
  std::copy(origin.begin(), origin.end(), part.origin);
  return part;
}

LoadedVolume cut_out(const std::string& path, const LoadedVolume& volume, const VoxelBox& box) {
  const plc_image& whole = volume.image;
  const plc_image image = image_of_box(path, whole, box);
  LoadedVolume part = make_volume(path, whole.type, image.dims);
  const auto size = static_cast<int64_t>(voxel_size(whole.type));
  const auto row = static_cast<size_t>(image.dims[0] * size);
  std::byte* to = part.bytes.data();
  for (int64_t z = box.low[2]; z <= box.high[2]; ++z) {
    for (int64_t y = box.low[1]; y <= box.high[1]; ++y, to += row) {
      const int64_t first = (z * whole.dims[1] + y) * whole.dims[0] + box.low[0];
      std::memcpy(to, volume.bytes.data() + first * size, row);
    }
  }
  const void* voxels = part.image.voxels;
  part.image = image;
  part.image.voxels = voxels;
  part.warnings = volume.warnings;
  return part;
}

}  // namespace plc::tools
