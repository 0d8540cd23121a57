// What guides a surface on a level: the image in mesh space, gradients, sizes, obstacles and
// places.
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/base/marks.h"
#include "engine/exact/predicates.h"
#include "engine/recover/recovery.h"
#include "engine/start/folds.h"
#include "kernels/ring_forces.h"
#include "pyramid/gradient.h"

namespace plc {

// The space and the guide of level h.
void Recovery::enter(int h) {
  entered_ = h;
  const MeshSpace before = space_;
  space_ = mesh_space(pyramid_, h, spec_.scale.anisotropy);
  mesh_.sizing = nullptr;
  if (!spec_.obstacle_abc.empty() && !obstacles_) place_obstacles();
  if (mesh_.vertex_count() != 0) change_space(mesh_, before, space_);
  guide_.image = image_view(pyramid_, h, spec_.pad_voxels, space_);
  // The bits of uniform ones are recorded.
  if (spec_.sizes) guide_.image.form.beyond = kBeyondWindow;
  guide_.iso = iso_of(h).value_or(0);
  guide_.metric = space_.metric;
  place_room();
  user_ = spec_.user;
  const auto place = [this](Vec3 voxel) {
    const auto& s = space_.step;
    return Vec3{voxel.x * static_cast<float>(s[0]), voxel.y * static_cast<float>(s[1]),
                voxel.z * static_cast<float>(s[2])};
  };
  for (Attachment& a : user_.attachments) a.place = place(a.place);
  for (Pin& p : user_.pins) p.place = place(p.place);
  for (size_t a = 0; a < 3; ++a) {
    user_.millimetres[a] = static_cast<float>(pyramid_.levels[0].voxel[a] / space_.step[a]);
  }
  if (spec_.force) {
    user_.force = [this, h](const Mesh& mesh, const Float4* position, Streams3& force) {
      return spec_.force(h, space_, mesh, position, force);
    };
  }
  guide_.user = &user_;
}

void Recovery::place_room() {
  const auto place = [this](const std::array<double, 3>& voxel) {
    return Vec3{static_cast<float>(voxel[0] * space_.step[0]),
                static_cast<float>(voxel[1] * space_.step[1]),
                static_cast<float>(voxel[2] * space_.step[2])};
  };
  guide_.room = {place(spec_.room_low), place(spec_.room_high)};
}

// Where missed places are looked for: of a patch the voxels within its room.
VoxelRoom Recovery::voxel_room() const {
  const ImageView& image = guide_.image;
  VoxelRoom room = whole_room(image);
  if (!mesh_.is_patch()) return room;
  room.inside = spec_.room_inside;
  const float low[3] = {guide_.room.low.x, guide_.room.low.y, guide_.room.low.z};
  const float high[3] = {guide_.room.high.x, guide_.room.high.y, guide_.room.high.z};
  for (size_t a = 0; a < 3; ++a) {
    const auto last = static_cast<float>(image.dims[a] - 1);
    const auto voxel = [&](float p) { return image.scale[a] * p + image.offset[a]; };
    room.low[a] = static_cast<int32_t>(std::ceil(std::clamp(voxel(low[a]), 0.0F, last)));
    room.high[a] = static_cast<int32_t>(std::floor(std::clamp(voxel(high[a]), 0.0F, last)));
  }
  return room;
}

void Recovery::place_obstacles() {
  Vector<double> xyz = std::move(spec_.obstacle_xyz);
  for (size_t i = 0; i < xyz.size(); ++i) {
    xyz[i] *= space_.step[i % 3];
    if (std::abs(xyz[i]) < kPredicateMin) xyz[i] = 0;
  }
  obstacles_.emplace(std::move(xyz), std::move(spec_.obstacle_abc),
                     spec_.obstacle_gap * delta_of(0), schedule_);
  mesh_.obstacles = &*obstacles_;
}

// The image that the gradient force (8) samples: its gradients are per U_h, with lengths measured
// as the forces measure them.
Status Recovery::build_gradient_image() {
  const Model& model = spec_.model;
  if (model.gradient_normal == 0 && model.gradient_tangent == 0) return {};
  const float metric[3] = {space_.metric.x, space_.metric.y, space_.metric.z};
  std::array<double, 3> voxel;
  for (size_t a = 0; a < 3; ++a) {
    voxel[a] = static_cast<double>(metric[a]) / static_cast<double>(guide_.image.scale[a]) /
               unit_of(level_);
    guide_.gradient.dims[a] = guide_.image.dims[a];
    guide_.gradient.scale[a] = guide_.image.scale[a];
    guide_.gradient.offset[a] = guide_.image.offset[a];
  }
  Status s = build_gradient(image_of(level_), voxel, spec_.gradient_bound, schedule_, gradient_);
  guide_.gradient.data = gradient_.data();
  return s;
}

// Derives the sizes of an adaptive mesh from the image of the level.
Status Recovery::build_sizing() {
  mesh_.sizing = nullptr;
  mesh_.stretch = 1;
  const std::optional<float> iso = iso_of(level_);
  if (!spec_.sizes || !iso) return {};
  sizing_.object = {guide_.image, *iso, spec_.inside_above};
  sizing_.full_image = level_ == 0;
  // What is around a patch makes sizes fine beyond its room, too, as far as they grow from the
  // finest to the coarsest.
  VoxelRoom room = voxel_room();
  for (size_t a = 0; a < 3 && mesh_.is_patch(); ++a) {
    const double away = (spec_.sizes->coarsest - spec_.sizes->finest) / spec_.sizes->slope *
                        mesh_.delta * static_cast<double>(guide_.image.scale[a]);
    const auto voxels = static_cast<int32_t>(std::min(away, 1e6));
    room.low[a] = std::max(0, room.low[a] - voxels);
    room.high[a] = std::min(guide_.image.dims[a] - 1, room.high[a] + voxels);
  }
  if (Status s = sizing_.field.build(guide_.image, *iso, mesh_.delta, *spec_.sizes, schedule_,
                                     level_ == 0 ? spec_.pad_voxels : 0, room);
      !s.ok()) {
    return s;
  }
  mesh_.sizing = &sizing_;
  mesh_.stretch = kSizedStretch;
  mesh_.longest_edge = mesh_.longest_sized_edge();
  lower_sizes();
  return {};
}

// To those of late bubbles and folds, where the level has had some. A bubble starts around its
// voxels; at folds the surface is already: sizes as fine around them, too, would bring it nearer by
// 4 to 12 % with 19 to 36 % more vertices.
void Recovery::lower_sizes() {
  const auto lower = [this](const VoxelSet& voxels, int32_t around) {
    voxels.visit(
        [&](const Voxel& voxel) { sizing_.field.lower(voxel, late_size(mesh_, voxel), around); });
  };
  lower(tried_, 1);
  lower(folds_, 0);
  sizing_.field.bound_slope();
}

// To what they are where the vertices are now. Ends of edges that violate (1) or (2) by them start
// anew: they are awake, and have not turned.
void Recovery::resize_all() {
  const auto delta = static_cast<float>(mesh_.delta);
  Buffer<uint8_t> violated(mesh_.padded());
  run_blocks(schedule_, mesh_.slots(), kGrain, [&](size_t, size_t begin, size_t end) {
    for (size_t v = begin; v < end; ++v) mesh_.resize(static_cast<uint32_t>(v));
  });
  run_blocks(schedule_, mesh_.padded(), kGrain, [&](size_t, size_t begin, size_t end) {
    kernels::edge_violations(
        schedule_.simd(), mesh_.rings(), mesh_.position.data(), delta * delta,
        kMaxEdge * kMaxEdge * delta * delta,
        Blocks::range(static_cast<uint32_t>(begin), static_cast<uint32_t>(end)), violated.data());
  });
  visit_marks(violated.data(), mesh_.slots(), [&](uint32_t v) {
    mesh_.wake(v);
    mesh_.turns[v] = 0;
  });
}

}  // namespace plc
