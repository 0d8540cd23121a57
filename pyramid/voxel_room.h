// A box of voxels of a level: where alone a part of a surface is worked on.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/image.h"

namespace plc {

// Voxels low .. high, both within. inside: whether it is, where it has no part of the surface.
struct VoxelRoom {
  std::array<int32_t, 3> low, high;
  bool inside = false;

  // Voxels along an axis.
  size_t width(size_t axis) const {
    const int64_t voxels = int64_t{high[axis]} - low[axis] + 1;
    return static_cast<size_t>(voxels);
  }
};

inline VoxelRoom whole_room(const ImageView& image) {
  return {{0, 0, 0}, {image.dims[0] - 1, image.dims[1] - 1, image.dims[2] - 1}, false};
}

}  // namespace plc
