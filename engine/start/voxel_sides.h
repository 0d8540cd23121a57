// Which voxels of an image a surface encloses.
#pragma once
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "engine/start/voxel_set.h"
#include "kernels/image.h"
#include "pyramid/memory.h"
#include "pyramid/voxel_room.h"

namespace plc {

// Parity of crossings along rows of voxels: kept are the crossings, which follow the surface, and a
// row of sides is made of them when it is asked for. A voxel centre within rounding of the surface
// may be on either side. The image's values are not read.
//
// Of a patch, whose faces are all there around the room: what its rows begin with is told by
// crossings along one column and the rows of one plane, and which of both sides is inside by the
// faces.
class VoxelSides {
 public:
  VoxelSides(const Mesh& mesh, const ImageView& image, const VoxelRoom& room);
  VoxelSides(const Mesh& mesh, const ImageView& image)
      : VoxelSides(mesh, image, whole_room(image)) {}

  // False where a patch has faces, and none tells.
  bool known() const { return known_; }
  // inside[x - low] = 1 where the centre of voxel (x, y, z) lies inside the surface, else 0; of the
  // room's x. False, and all are 0, where no voxel of the row does. From any thread.
  bool row(int32_t y, int32_t z, uint8_t* inside) const;

 private:
  class Rows;
  void begin_rows(const Mesh& mesh, const ImageView& image);
  size_t index_of(int64_t y, int64_t z) const {
    return static_cast<size_t>((z - room_.low[2]) * (room_.high[1] - room_.low[1] + 1) + y -
                               room_.low[1]);
  }

  VoxelRoom room_;
  VoxelSet flips_;         // voxels on another side than the one before them in their row
  Vector<uint8_t> first_;  // of a patch: the side that a row of the room begins on
  bool known_ = true;
};

}  // namespace plc
