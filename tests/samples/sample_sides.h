// Sides of all voxels at once, a byte each.
#pragma once
#include <vector>

#include "engine/start/voxel_sides.h"
#include "pyramid/memory.h"

namespace samples {

inline plc::Vector<uint8_t> sides_of(const plc::Mesh& mesh, const plc::ImageView& image) {
  const plc::VoxelSides sides(mesh, image);
  const auto width = static_cast<size_t>(image.dims[0]);
  plc::Vector<uint8_t> inside(width * static_cast<size_t>(image.dims[1]) *
                              static_cast<size_t>(image.dims[2]));
  uint8_t* row = inside.data();
  for (int32_t z = 0; z < image.dims[2]; ++z) {
    for (int32_t y = 0; y < image.dims[1]; ++y, row += width) sides.row(y, z, row);
  }
  return inside;
}

}  // namespace samples
