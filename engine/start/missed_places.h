// Where an image and a surface disagree about what is inside, too far from the surface for it to
// get there by moving.
#pragma once
#include <array>
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "engine/start/voxel_set.h"
#include "engine/start/voxel_sides.h"
#include "pyramid/executor.h"
#include "pyramid/image_object.h"

namespace plc {

enum class Missed : uint8_t { kPart, kCavity };

struct MissedPlaces {
  std::array<VoxelSet, 2> voxels;      // of the places of each kind that are to get a bubble
  std::array<int64_t, 2> count{0, 0};  // places of each kind
  // Their box, voxels; low > high where there are none.
  std::array<Voxel, 2> low, high;

  bool is(const Voxel& voxel, Missed m) const { return voxels[static_cast<size_t>(m)].has(voxel); }
};

// What counts as a place, and as a part of it; mesh units.
struct PlaceLimits {
  float clearance;
  float radius;
  float thinnest = 0;
};

// Places are sets of voxels connected by faces, edges or corners: of the object, outside the
// surface - or not of it, and inside - and none within `clearance` of a vertex or, where the mesh
// is adaptive, of a face. Left out are those that hold no ball of `radius`, where the mesh is
// adaptive nor kPlaceVoxels voxels, and those with a voxel that `tried` holds; and where the mesh
// is adaptive those in parts of the object of which no kPlaceVoxels voxels are joined by faces
// (joined_voxels.h), and where it is noisy (kNoisy) all voxels that are not joined to so many on
// their side of iso. The others are put into `tried`, which is of the image's voxels or of none
// yet. Of a place those voxels get a bubble where the image is on the same side of iso for
// `thinnest` along each axis, and those beside them; a place without any gets none. The same for
// any executor.
//
// room: of a patch, where all of its faces are and where alone is looked; of others the image.
MissedPlaces find_missed_places(const Mesh& mesh, const ImageObject& object,
                                const PlaceLimits& limits, const Executor& executor,
                                VoxelSet& tried, const VoxelRoom& room);

}  // namespace plc
