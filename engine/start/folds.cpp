#include "engine/start/folds.h"

#include <algorithm>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/transform/edge.h"

namespace plc {

bool find_folds(const Mesh& mesh, const ImageView& image, VoxelSet& folds) {
  // Sizes are whole steps.
  const float least = std::max(kLateSize, mesh.sizing->field.finest()) - 1 + SizeField::kStep;
  bool any = false;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (!mesh.alive(v) || mesh.is_absent(v) || mesh.position[v].w <= least) continue;
    if (!bends(mesh, v, kFoldCosine)) continue;
    const Vec3 p = mesh.at(v);
    const float xyz[3] = {p.x, p.y, p.z};
    Voxel at;
    for (size_t a = 0; a < 3; ++a) {
      const float nearest = std::round(image.scale[a] * xyz[a] + image.offset[a]);
      const auto last = static_cast<float>(image.dims[a] - 1);
      at[a] = static_cast<int32_t>(std::clamp(nearest, 0.0F, last));
    }
    if (!folds.has_image()) folds = VoxelSet(image.dims);
    folds.insert(at);
    any = true;
  }
  return any;
}

}  // namespace plc
