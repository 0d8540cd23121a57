#include "engine/start/level_start.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <string>

#include "engine/base/constants.h"
#include "engine/base/mesh_arrays.h"
#include "engine/guard/obstacles.h"
#include "engine/mesh/face_rings.h"
#include "engine/mesh/mesh_append.h"
#include "engine/resolve/conform.h"
#include "engine/start/initial_surface.h"
#include "engine/start/mesh_import.h"
#include "engine/start/regular_iso_surface.h"
#include "engine/start/stretched_bubble.h"
#include "kernels/image_value.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

constexpr double kSeedReach = 4;

const PyramidLevel& image_of(const LevelImage& level) {
  return level.pyramid.levels[static_cast<size_t>(level.h)];
}

ImageView view_of(const LevelImage& level, const Pyramid& pyramid) {
  return image_view(pyramid, level.h, level.pad, level.space);
}

struct VoxelBox {
  std::array<int64_t, 3> low, high;  // low > high where it is empty
};

// Grows the box by the voxels of slice z on the object's side of iso.
void add_slice(const ImageObject& object, int64_t z, VoxelBox& box) {
  const ImageView& image = object.image;
  Vector<float> row(static_cast<size_t>(image.dims[0]));
  const auto is_object = [&](float v) { return object.has(v); };
  for (int64_t y = 0; y < image.dims[1]; ++y) {
    image_row(image, y, z, row.data());
    const auto first = std::find_if(row.begin(), row.end(), is_object);
    if (first == row.end()) continue;
    const auto last = std::find_if(row.rbegin(), row.rend(), is_object);
    const std::array<int64_t, 3> low{first - row.begin(), y, z};
    const std::array<int64_t, 3> high{row.rend() - last - 1, y, z};
    for (size_t a = 0; a < 3; ++a) {
      box.low[a] = std::min(box.low[a], low[a]);
      box.high[a] = std::max(box.high[a], high[a]);
    }
  }
}

// The box of mesh space that the part of the image on the object's side of iso fills; false when it
// is empty.
bool object_extent(const LevelImage& level, const Executor& executor, Extent& box) {
  const PyramidLevel& image = image_of(level);
  const ImageObject object{level_image(image), *level.iso, level.inside_above};
  Vector<VoxelBox> slices(static_cast<size_t>(image.dims[2]), VoxelBox{image.dims, {-1, -1, -1}});
  executor.run(slices.size(),
               [&](size_t z) { add_slice(object, static_cast<int64_t>(z), slices[z]); });
  std::array<int64_t, 3> low = image.dims;
  std::array<int64_t, 3> high{-1, -1, -1};
  for (const VoxelBox& slice : slices) {
    for (size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], slice.low[a]);
      high[a] = std::max(high[a], slice.high[a]);
    }
  }
  const ImageView view = view_of(level, level.pyramid);
  for (size_t a = 0; a < 3; ++a) {
    if (high[a] < 0) return false;
    // Half a voxel more: where the iso-surface may lie.
    const auto at = [&](double voxel) {
      return (voxel - static_cast<double>(view.offset[a])) / static_cast<double>(view.scale[a]);
    };
    box.low[a] = at(static_cast<double>(low[a]) - 0.5);
    box.high[a] = at(static_cast<double>(high[a]) + 0.5);
  }
  return true;
}

// What the input image fills, without its padding.
Extent image_extent(const LevelImage& level) {
  Extent box;
  for (size_t a = 0; a < 3; ++a) {
    const auto voxels =
        static_cast<double>(level.pyramid.levels[0].dims[a] - int64_t{2} * level.pad);
    box.low[a] = -0.5 * level.space.step[a];
    box.high[a] = (voxels - 0.5) * level.space.step[a];
  }
  return box;
}

std::string name_of(size_t seed) {
  return "seed " + std::to_string(seed);
}

// The longest of a length in the mesh along its axes.
double in_mm(double length, const LevelImage& level) {
  double mm = 0;
  for (size_t a = 0; a < 3; ++a) {
    mm = std::max(mm, level.pyramid.levels[0].voxel[a] / level.space.step[a]);
  }
  return length * mm;
}

// In mesh units; spheres of mm are ellipsoids where the mesh lives in voxels.
struct Ellipsoid {
  Vec3 centre, radii;
};

Ellipsoid ellipsoid_of(const Seed& seed, const MeshSpace& space) {
  const auto scaled = [&](const std::array<double, 3>& p) {
    return Vec3{static_cast<float>(p[0] * space.step[0]), static_cast<float>(p[1] * space.step[1]),
                static_cast<float>(p[2] * space.step[2])};
  };
  return {scaled(seed.centre), scaled(seed.radii)};
}

// Whether it leads beyond the image by no more than kSeedReach diagonals of that: what is farther
// only takes memory.
bool within_reach(const Seed& seed, const MeshSpace& space, const Extent& image) {
  double squared_diagonal = 0;
  for (size_t a = 0; a < 3; ++a) {
    squared_diagonal += (image.high[a] - image.low[a]) * (image.high[a] - image.low[a]);
  }
  const double room = kSeedReach * std::sqrt(squared_diagonal);
  for (size_t a = 0; a < 3; ++a) {
    const double centre = seed.centre[a] * space.step[a];
    const double radius = seed.radii[a] * space.step[a];
    if (!(centre - radius >= image.low[a] - room)) return false;
    if (!(centre + radius <= image.high[a] + room)) return false;
  }
  return true;
}

// Whether two ellipsoids with parallel axes may be nearer than `gap`: grown by half of it, the
// Minkowski sum of both lies within the ellipsoid of the summed radii.
bool near(const Ellipsoid& a, const Ellipsoid& b, float gap) {
  const Vec3 way = b.centre - a.centre;
  const Vec3 reach = a.radii + b.radii + Vec3{gap, gap, gap};
  return squared({way.x / reach.x, way.y / reach.y, way.z / reach.z}) < 1;
}

Status bubble_around(const Extent& box, double delta, const Schedule& schedule, Mesh& mesh) {
  constexpr int kPower = 4;  // as make_bubble() has it
  const std::array<double, 3> half = bubble_half(box, delta);
  if (!is_stretched(half)) return make_bubble(mesh, box, delta, schedule);
  return make_stretched_bubble(mesh, box.middle(), half, kPower, delta, schedule);
}

Status append_seed(const Ellipsoid& e, const Schedule& schedule, Mesh& mesh) {
  const std::array<double, 3> half{e.radii.x, e.radii.y, e.radii.z};
  if (!is_stretched(half)) return append_bubble(mesh, e.centre, e.radii, schedule);
  constexpr int kPower = 2;
  Mesh bubble;
  Status s = make_stretched_bubble(bubble, {e.centre.x, e.centre.y, e.centre.z}, half, kPower,
                                   mesh.delta, schedule);
  if (!s.ok()) return s;
  if (uint64_t{mesh.slots()} + bubble.slots() > kMaxMeshVertices) return too_many_vertices();
  append_mesh(mesh, bubble, false, [](Vec3 p) { return p; });
  return {};
}

Status make_seeds(const StartSpec& spec, const LevelImage& level, double delta,
                  const Schedule& schedule, Mesh& mesh) {
  const auto unit = static_cast<float>(delta);
  mesh.delta = delta;
  const Extent image = image_extent(level);
  Vector<Ellipsoid> made;
  for (const Seed& seed : spec.seeds) {
    const std::string name = name_of(made.size());
    if (!within_reach(seed, level.space, image)) {
      return {ErrorCode::kInvalidArgument, name + ": leads too far beyond the image"};
    }
    const Ellipsoid e = ellipsoid_of(seed, level.space);
    if (std::min({e.radii.x, e.radii.y, e.radii.z}) < kSmallestBubble * unit) {
      char line[120];
      std::snprintf(line, sizeof line,
                    ": too small for level %d, where the smallest radius is %.3g mm; use fewer "
                    "levels or larger seeds",
                    level.h, in_mm(kSmallestBubble * delta, level));
      return {ErrorCode::kInvalidArgument, name + line};
    }
    for (size_t i = 0; i < made.size(); ++i) {
      if (near(made[i], e, kBubbleGap * unit)) {
        return {ErrorCode::kInvalidArgument,
                name + ": touches " + name_of(i) + " on level " + std::to_string(level.h)};
      }
    }
    made.push_back(e);
    if (Status s = append_seed(e, schedule, mesh); !s.ok()) return s;
  }
  return {};
}

Status make_mesh(const StartSpec& spec, const LevelImage& level, const Executor& executor,
                 Mesh& mesh) {
  const Extent image = image_extent(level);
  for (size_t i = 0; i < spec.xyz.size(); i += 3) {
    const Seed point{{spec.xyz[i], spec.xyz[i + 1], spec.xyz[i + 2]}, {0, 0, 0}};
    // What is not finite import_mesh() refuses.
    const bool finite = std::isfinite(spec.xyz[i] + spec.xyz[i + 1] + spec.xyz[i + 2]);
    if (finite && !within_reach(point, level.space, image)) {
      return {ErrorCode::kInvalidArgument,
              "vertex " + std::to_string(i / 3) + " of the mesh lies too far beyond the image"};
    }
  }
  Vector<double> xyz(spec.xyz.size());
  for (size_t i = 0; i < xyz.size(); ++i) xyz[i] = spec.xyz[i] * level.space.step[i % 3];
  return import_mesh(arrays_of(xyz, spec.abc), executor, mesh,
                     spec.as_given.empty() ? nullptr : spec.as_given.data(),
                     spec.patch ? spec.held.data() : nullptr);
}

// Every so many voxels of an image that is finer than delta on some axis (level_delta): a surface
// that follows all of them is so crowded that conform() takes minutes.
Status coarse_iso_surface(const ImageObject& object, const std::array<int32_t, 3>& stride,
                          const Schedule& schedule, int64_t least, const StartHooks& hooks,
                          Mesh& mesh) {
  const ImageView& view = object.image;
  ImageView coarse = view;
  for (size_t a = 0; a < 3; ++a) {
    const auto step = static_cast<float>(stride[a]);
    coarse.dims[a] = (view.dims[a] - 1) / stride[a] + 1;
    coarse.scale[a] = view.scale[a] / step;
    coarse.offset[a] = view.offset[a] / step;
  }
  const auto at = [&](int32_t x, int32_t y, int32_t z) {
    return image_value(view, int64_t{x} * stride[0], int64_t{y} * stride[1],
                       int64_t{z} * stride[2]);
  };
  const auto sides = [&](int32_t y, int32_t z, uint8_t* inside) {
    for (int32_t x = 0; x < coarse.dims[0]; ++x) inside[x] = object.has(at(x, y, z));
  };
  return regular_iso_surface({coarse, object.iso, object.above}, {sides, at}, schedule, mesh, least,
                             hooks);
}

// An image without the object is no error: the next finer level may show it.
Status make_iso(const ImageObject& object, double delta, const Schedule& schedule, int64_t least,
                const StartHooks& hooks, Mesh& mesh) {
  std::array<int32_t, 3> stride{};
  for (size_t a = 0; a < 3; ++a) {
    stride[a] =
        std::max(1, static_cast<int32_t>(delta * static_cast<double>(object.image.scale[a])));
  }
  Status s = stride == std::array<int32_t, 3>{1, 1, 1}
                 ? regular_iso_surface(object, values_of(object), schedule, mesh, least, hooks)
                 : coarse_iso_surface(object, stride, schedule, least, hooks, mesh);
  return s.code() == ErrorCode::kInvalidData ? Status() : s;
}

Status make_start(const StartSpec& spec, const LevelImage& level, double delta,
                  const Schedule& schedule, const StartHooks& hooks, Mesh& mesh) {
  Extent box;
  switch (spec.init) {
    case Init::kBubble:
      if (!level.iso) box = image_extent(level);
      if (level.iso && !object_extent(level, schedule, box)) return {};
      return bubble_around(box, delta, schedule, mesh);
    case Init::kBubbles:
      return make_bubbles(mesh, image_extent(level), spec.bubbles, delta, schedule);
    case Init::kSeeds:
      return make_seeds(spec, level, delta, schedule, mesh);
    case Init::kIso:
      assert(level.iso);
      if (mesh.sizing != nullptr) {
        return make_iso(mesh.sizing->object, delta, schedule, kPlaceVoxels, hooks, mesh);
      }
      return make_iso({view_of(level, level.pyramid), *level.iso, level.inside_above}, delta,
                      schedule, 0, hooks, mesh);
    case Init::kMask:
      return make_iso({view_of(level, spec.mask), 0.5F, true}, delta, schedule, 0, hooks, mesh);
    case Init::kMesh:
      return make_mesh(spec, level, schedule, mesh);
  }
  return {ErrorCode::kInternal, "start: no such kind"};
}

// The surface is made without them.
Status check_obstacles(const Mesh& mesh, const LevelImage& level) {
  Obstacles::Meeting meeting;
  if (!mesh.obstacles->find_meeting(mesh, meeting)) return {};
  const Vec3 p = mesh.at(meeting.face[0]);
  std::array<double, 3> voxel{};
  for (size_t a = 0; a < 3; ++a) {
    voxel[a] = static_cast<double>(a == 0 ? p.x : a == 1 ? p.y : p.z) / level.space.step[a];
  }
  char line[160];
  std::snprintf(line, sizeof line,
                "obstacles: face %u meets the surface to start from, near voxel (%.6g, %.6g, %.6g)",
                meeting.obstacle, voxel[0], voxel[1], voxel[2]);
  return {ErrorCode::kInvalidData, line};
}

}  // namespace

Status start_surface(const StartSpec& spec, const LevelImage& level, double delta,
                     const Schedule& schedule, Mesh& mesh, OperationCounts& counts,
                     const StartHooks& hooks) {
  mesh.clear();
  mesh.delta = delta;
  if (spec.patch && spec.abc.empty()) {
    mesh.hold({});
    return {};
  }
  Status made = make_start(spec, level, delta, schedule, hooks, mesh);
  if (!made.ok() || mesh.vertex_count() == 0) return made;
  if (mesh.obstacles != nullptr) {
    if (Status s = check_obstacles(mesh, level); !s.ok()) return s;
  }
  // A patch is fitted to what it is a part of when its level starts.
  if (!spec.conforms() || mesh.is_patch()) return {};
  Status s = conform(mesh, delta, schedule, counts, hooks.go_on);
  // Where nothing is left, a finer level may resolve it; but for a mesh that was given.
  const bool resolved = mesh.vertex_count() != 0 || spec.init == Init::kMesh;
  return resolved || s.code() == ErrorCode::kCancelled ? s : Status();
}

}  // namespace plc
