#include "engine/mesh/mesh_space.h"

#include "engine/base/constants.h"

namespace plc {

MeshSpace mesh_space(const Pyramid& pyramid, int h, Anisotropy anisotropy) {
  MeshSpace space;
  if (anisotropy == Anisotropy::kVoxel) return space;
  const PyramidLevel& finest = pyramid.levels[0];
  const PyramidLevel& level = pyramid.levels[static_cast<size_t>(h)];
  std::array<double, 3> metric{1, 1, 1};
  for (size_t a = 0; a < 3; ++a) {
    if (anisotropy == Anisotropy::kMetric) metric[a] = level.voxel[a] / level.unit;
    space.step[a] = finest.voxel[a] / finest.unit / metric[a];
  }
  space.metric = {static_cast<float>(metric[0]), static_cast<float>(metric[1]),
                  static_cast<float>(metric[2])};
  return space;
}

double level_delta(const Pyramid& pyramid, int h, const MeshScale& scale) {
  const PyramidLevel& level = pyramid.levels[static_cast<size_t>(h)];
  double unit = level.unit / pyramid.levels[0].unit;
  if (scale.anisotropy == Anisotropy::kPhysical) {
    double cubes =
        level.voxel[0] / level.unit * (level.voxel[1] / level.unit) * (level.voxel[2] / level.unit);
    while (cubes > kCubesPerVoxel) {
      cubes /= 8;
      unit *= 2;
    }
  }
  return scale.edges * unit / kUnitPerDelta;
}

void change_space(Mesh& mesh, const MeshSpace& from, const MeshSpace& to) {
  if (from.step == to.step) return;
  std::array<float, 3> factor;
  for (size_t a = 0; a < 3; ++a) factor[a] = static_cast<float>(to.step[a] / from.step[a]);
  const auto scaled = [&](Vec3 p) {
    return Vec3{p.x * factor[0], p.y * factor[1], p.z * factor[2]};
  };
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (!mesh.alive(v)) continue;
    mesh.place(v, scaled(mesh.at(v)));
    mesh.velocity.set(v, scaled(mesh.velocity.at(v)));
  }
}

// Voxel i of the unpadded I_0 is voxel i + pad of the padded one and lies at (i + pad + 1/2) of its
// voxels from the border: (10).
ImageView image_view(const Pyramid& pyramid, int h, int pad, const MeshSpace& space) {
  const PyramidLevel& level = pyramid.levels[static_cast<size_t>(h)];
  ImageView view = level_image(level);
  for (size_t a = 0; a < 3; ++a) {
    const double voxels_per_voxel = pyramid.levels[0].voxel[a] / level.voxel[a];
    view.scale[a] = static_cast<float>(voxels_per_voxel / space.step[a]);
    view.offset[a] = static_cast<float>((pad + 0.5) * voxels_per_voxel - 0.5);
  }
  return view;
}

}  // namespace plc
