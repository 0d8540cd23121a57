#include "engine/start/folds.h"

#include <algorithm>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/start/thickness.h"
#include "engine/transform/edge.h"

namespace plc {

float late_size(const Mesh& mesh, const Voxel& voxel) {
  const Sizing& sizing = *mesh.sizing;
  const float thin = kThin * static_cast<float>(mesh.delta);
  return sizing.full_image && is_thin(sizing.object, voxel, thin) ? kThinSize : kLateSize;
}

bool find_folds(const Mesh& mesh, VoxelSet& folds) {
  const ImageView& image = mesh.sizing->object.image;
  const float finest = mesh.sizing->field.finest();
  // Sizes are whole steps.
  const auto is_above = [&](uint32_t v, float size) {
    return mesh.position[v].w > std::max(size, finest) - 1 + SizeField::kStep;
  };
  bool any = false;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (!mesh.alive(v) || mesh.is_absent(v) || !is_above(v, kThinSize)) continue;
    if (!bends(mesh, v, kFoldCosine)) continue;
    const Vec3 p = mesh.at(v);
    const float xyz[3] = {p.x, p.y, p.z};
    Voxel at;
    for (size_t a = 0; a < 3; ++a) {
      const float nearest = std::round(image.scale[a] * xyz[a] + image.offset[a]);
      const auto last = static_cast<float>(image.dims[a] - 1);
      at[a] = static_cast<int32_t>(std::clamp(nearest, 0.0F, last));
    }
    if (!is_above(v, late_size(mesh, at))) continue;
    if (!folds.has_image()) folds = VoxelSet(image.dims);
    folds.insert(at);
    any = true;
  }
  return any;
}

}  // namespace plc
