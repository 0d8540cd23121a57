// Which voxels of an image a closed surface encloses.
#pragma once
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "engine/start/voxel_set.h"
#include "kernels/image.h"

namespace plc {

// Parity of crossings along rows of voxels: kept are the crossings, which follow the surface, and a
// row of sides is made of them when it is asked for. A voxel centre within rounding of the surface
// may be on either side. The image's values are not read.
class VoxelSides {
 public:
  VoxelSides(const Mesh& mesh, const ImageView& image);

  // inside[x] = 1 where the centre of voxel (x, y, z) lies inside the surface, else 0. False, and
  // all are 0, where no voxel of the row does. From any thread.
  bool row(int32_t y, int32_t z, uint8_t* inside) const;

 private:
  int32_t width_;
  VoxelSet flips_;  // voxels on another side than the one before them in their row
};

}  // namespace plc
