// What of a surface holds crumbs of the object alone.
#pragma once
#include <cstdint>

#include "engine/mesh/mesh.h"
#include "pyramid/image_object.h"

namespace plc {

// Deletes the components that have fewer than kPlaceVoxels voxels of the object beneath them, none
// of them one of so many that are joined by faces (joined_voxels.h): what the image joins to more
// by edges and corners, and has come off, and ends of what broke. Components stay that have
// cavities or obstacles in them, and the largest. Returns how many were deleted. The object's image
// is in the mesh's space; the mesh is no patch.
int64_t delete_crumbs(Mesh& mesh, const ImageObject& object);

}  // namespace plc
