#include "tools/volume/volume_io_memory.h"

#include <limits>
#include <new>

#include "tools/file/failure.h"
#include "tools/file/memory.h"

namespace plc::tools {

size_t voxel_size(plc_voxel_type type) {
  switch (type) {
    case PLC_U8:
      return 1;
    case PLC_I16:
    case PLC_U16:
      return 2;
    case PLC_I32:
    case PLC_F32:
      return 4;
  }
  return 0;
}

std::string dims_text(const int64_t dims[3]) {
  return std::to_string(dims[0]) + " x " + std::to_string(dims[1]) + " x " +
         std::to_string(dims[2]);
}

int64_t checked_voxel_count(const std::string& path, const int64_t dims[3]) {
  int64_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] < 1) throw Failure{path + ": has no voxels (" + dims_text(dims) + ")"};
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (dims[axis] < 2) {
      throw Failure{path + ": is not a volume (" + dims_text(dims) +
                    " voxels; at least 2 along each axis are needed)"};
    }
    if (dims[axis] > std::numeric_limits<int64_t>::max() / 8 / count) {
      throw Failure{path + ": is too large (" + dims_text(dims) + " voxels)"};
    }
    count *= dims[axis];
  }
  return count;
}

LoadedVolume make_volume(const std::string& path, plc_voxel_type type, const int64_t dims[3]) {
  const auto count = static_cast<uint64_t>(checked_voxel_count(path, dims));
  LoadedVolume volume;
  // Not plc_image_defaults: the tools' library stands without the engine's.
  volume.image.struct_size = sizeof volume.image;
  volume.image.type = type;
  for (int axis = 0; axis < 3; ++axis) {
    volume.image.dims[axis] = dims[axis];
    volume.image.spacing[axis] = 1;
    volume.image.direction[4 * axis] = 1;
  }
  require_memory(path, count * voxel_size(type));
  try {
    volume.bytes = SharedBytes(count * voxel_size(type));
  } catch (const std::bad_alloc&) {
    throw Failure{path + ": not enough memory for " + dims_text(dims) + " voxels"};
  }
  volume.image.voxels = volume.bytes.data();
  return volume;
}

}  // namespace plc::tools
