// What of a surface holds crumbs of the object alone.
#pragma once
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "pyramid/image_object.h"

namespace plc {

// Deletes the components that have nowhere a voxel beneath them of which kPlaceVoxels of the object
// are joined by faces (joined_voxels.h): what noise has joined to more by edges and corners, and
// has come off again, and the ends of what broke. Components stay that have cavities, whole or in
// part of what is held of a patch, and, but for a patch, the largest. Returns how many were
// deleted. The object's image is in the mesh's space.
int64_t delete_crumbs(Mesh& mesh, const ImageObject& object);

}  // namespace plc
