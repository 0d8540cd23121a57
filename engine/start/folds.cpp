#include "engine/start/folds.h"

#include <algorithm>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/base/vec3.h"

namespace plc {

namespace {

// visit(normal, as long as twice the area) for the faces of a vertex.
template <typename Visit>
void visit_normals(const Mesh& mesh, uint32_t v, const Visit& visit) {
  const uint32_t count = mesh.valence(v);
  const Vec3 p = mesh.at(v);
  Vec3 before = mesh.at(mesh.neighbor(v, count - 1)) - p;
  for (uint32_t k = 0; k < count; ++k) {
    const Vec3 next = mesh.at(mesh.neighbor(v, k)) - p;
    visit(cross(before, next));
    before = next;
  }
}

bool is_fold(const Mesh& mesh, uint32_t v) {
  Vec3 sum;
  visit_normals(mesh, v, [&](Vec3 n) { sum = sum + n; });
  bool fold = false;
  visit_normals(
      mesh, v, [&](Vec3 n) { fold = fold || dot(n, sum) < kFoldCosine * length(n) * length(sum); });
  return fold;
}

}  // namespace

bool find_folds(const Mesh& mesh, const ImageView& image, VoxelSet& folds) {
  // Sizes are whole steps.
  const float least = std::max(kLateSize, mesh.sizing->field.finest()) - 1 + SizeField::kStep;
  bool any = false;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (!mesh.alive(v) || mesh.is_absent(v) || mesh.position[v].w <= least) continue;
    if (!is_fold(mesh, v)) continue;
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
