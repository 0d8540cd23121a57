// Which voxels of an image a closed surface encloses.
#pragma once
#include <cstdint>

#include "engine/mesh.h"
#include "kernels/image.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"

namespace plc {

// inside[i] = 1 where the centre of voxel i lies inside the surface, else 0; x fastest. Parity of
// crossings along rows of voxels. A voxel centre within rounding of the surface may be on either
// side. The same for any executor.
void voxel_sides(const Mesh& mesh, const ImageView& image, const Executor& executor,
                 Buffer<uint8_t>& inside);

}  // namespace plc
