#include "engine/start/folds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/start/thickness.h"
#include "engine/transform/edge.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

bool is_thin(const Sizing& sizing, const Voxel& voxel, double delta) {
  return sizing.full_image && is_thin(sizing.object, voxel, kThin * static_cast<float>(delta));
}

// Whether sizes `above` delta are more than that, and than the finest. Sizes are whole steps.
bool is_above(const SizeField& field, float above, float size) {
  return above > std::max(size, field.finest()) - 1 + SizeField::kStep;
}

Voxel nearest_voxel(const ImageView& image, Vec3 p) {
  const float xyz[3] = {p.x, p.y, p.z};
  Voxel at;
  for (size_t a = 0; a < 3; ++a) {
    const float nearest = std::round(image.scale[a] * xyz[a] + image.offset[a]);
    at[a] = static_cast<int32_t>(std::clamp(nearest, 0.0F, static_cast<float>(image.dims[a] - 1)));
  }
  return at;
}

void insert(const Voxel& voxel, const ImageView& image, VoxelSet& folds) {
  if (!folds.has_image()) folds = VoxelSet(image.dims);
  folds.insert(voxel);
}

}  // namespace

float late_size(const Mesh& mesh, const Voxel& voxel) {
  return is_thin(*mesh.sizing, voxel, mesh.delta) ? kThinSize : kLateSize;
}

bool find_folds(const Mesh& mesh, VoxelSet& folds) {
  const Sizing& sizing = *mesh.sizing;
  bool any = false;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const float above = mesh.position[v].w;
    if (!mesh.alive(v) || mesh.is_absent(v) || !is_above(sizing.field, above, kThinSize)) continue;
    if (!bends(mesh, v, kFoldCosine)) continue;
    const Voxel at = nearest_voxel(sizing.object.image, mesh.at(v));
    if (!is_above(sizing.field, above, late_size(mesh, at))) continue;
    insert(at, sizing.object.image, folds);
    any = true;
  }
  return any;
}

bool find_folds(const Mesh& mesh, const HalfEdges& surface, const Buffer<float>& xyz,
                const Executor& executor, VoxelSet& folds) {
  constexpr size_t kBlock = 4096;
  const Sizing& sizing = *mesh.sizing;
  if (!sizing.full_image || sizing.field.noise() > kThinNoise) return false;
  const auto place = [&](uint32_t v) {
    const float* p = xyz.data() + size_t{3} * v;
    return Vec3{p[0], p[1], p[2]};
  };
  std::vector<Vector<Voxel>> found(block_count(surface.vertex_slots(), kBlock));
  run_blocks(executor, surface.vertex_slots(), kBlock, [&](size_t block, size_t begin, size_t end) {
    for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
      const Vec3 p = place(v);
      const auto visit_normals = [&](const auto& use) {
        surface.visit_ring(v, [&](uint32_t h) {
          const uint32_t last = HalfEdges::previous(h);
          use(area_vector(p, place(surface.to(h)), place(surface.from(last))));
        });
      };
      if (!normals_bend(visit_normals, kFoldCosine)) continue;
      if (!is_above(sizing.field, sizing.field.above_delta(p.x, p.y, p.z), kThinSize)) continue;
      const Voxel at = nearest_voxel(sizing.object.image, p);
      if (is_thin(sizing, at, mesh.delta)) found[block].push_back(at);
    }
  });
  bool any = false;
  for (const auto& voxels : found) {
    for (const Voxel& at : voxels) insert(at, sizing.object.image, folds);
    any = any || !voxels.empty();
  }
  return any;
}

}  // namespace plc
