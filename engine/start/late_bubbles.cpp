#include "engine/start/late_bubbles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/base/mesh_arrays.h"
#include "engine/measure/measures.h"
#include "engine/mesh/mesh_append.h"
#include "engine/resolve/conform.h"
#include "engine/start/regular_iso_surface.h"
#include "kernels/image_value.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// The part of the image around the places of one kind, with everything else turned to the other
// side of iso. Its values are made as they are asked for: it may be as large as the image.
class Cutout {
 public:
  Cutout(const ImageObject& object, const MissedPlaces& places, Missed kind)
      : image_(object.image),
        iso_(object.iso),
        up_(object.above == (kind == Missed::kPart)),
        voxels_(places.voxels[static_cast<size_t>(kind)]),
        view_(object.image) {
    const auto k = static_cast<size_t>(kind);
    for (size_t a = 0; a < 3; ++a) {
      // The places end a voxel from the border of the cutout: what is beyond is outside.
      first_[a] = places.low[k][a] - 1;
      view_.dims[a] = places.high[k][a] - first_[a] + 2;
      view_.offset[a] = image_.offset[a] - static_cast<float>(first_[a]);
    }
  }
  ImageObject object() const { return {view_, 0, true}; }  // dims, scale and offset
  LatticeValues values() const {
    return {[this](int32_t y, int32_t z, uint8_t* inside) { find_sides(y, z, inside); },
            [this](int32_t x, int32_t y, int32_t z) { return value(x, y, z); }};
  }

 private:
  static constexpr float kLeast = 1e-6F;

  // How far a value lies on the object's side of iso, for parts; on the other, for cavities.
  float depth(float value) const { return up_ ? value - iso_ : iso_ - value; }

  // Above 0 inside, or 0; below 0 outside.
  float value(int32_t x, int32_t y, int32_t z) const {
    const Voxel v{x + first_[0], y + first_[1], z + first_[2]};
    if (!is_within(image_.dims, v)) return -1;
    const float d = depth(image_value(image_, v[0], v[1], v[2]));
    return voxels_.has(v) ? std::max(d, 0.0F) : -std::max(std::abs(d), kLeast);
  }
  void find_sides(int32_t y, int32_t z, uint8_t* inside) const {
    const int32_t row = y + first_[1], plane = z + first_[2];
    std::fill_n(inside, view_.dims[0], uint8_t{0});
    if (!is_within(image_.dims, {0, row, plane})) return;
    const int32_t begin = std::max(first_[0], 0);
    const int32_t end = std::min(first_[0] + view_.dims[0], image_.dims[0]);
    voxels_.visit_row(row, plane, begin, end, [&](int32_t x) { inside[x - first_[0]] = 1; });
  }

  const ImageView& image_;
  float iso_;
  bool up_;  // whether larger values lie inside
  const VoxelSet& voxels_;
  Voxel first_{};
  ImageView view_;
};

double volume_of(const Mesh& mesh, const Executor& executor) {
  Vector<float> xyz;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const Vec3 p = mesh.at(v);
    xyz.insert(xyz.end(), {p.x, p.y, p.z});
  }
  return surface_measures(arrays_of(xyz, mesh.faces()), executor).volume;
}

}  // namespace

MissedPlaces find_late_places(const Mesh& mesh, const ImageObject& object, const Executor& executor,
                              VoxelSet& tried, const VoxelRoom& room) {
  const auto delta = static_cast<float>(mesh.delta);
  // A vertex of an iso-surface lies at most 0.9 of a voxel's diagonal from a voxel of the place.
  float diagonal = 0;
  for (const float scale : object.image.scale) diagonal += 1 / (scale * scale);
  const float finest = mesh.sizing == nullptr ? delta : delta * mesh.sizing->field.finest();
  const PlaceLimits limits{kBubbleGap * finest + 0.9F * std::sqrt(diagonal),
                           kSmallestBubble * delta,
                           mesh.sizing == nullptr ? kThinSheet * delta : 0};
  return find_missed_places(mesh, object, limits, executor, tried, room);
}

Status start_late_bubbles(const ImageObject& object, const MissedPlaces& places,
                          const Schedule& schedule, Mesh& mesh, LateBubbles& started,
                          OperationCounts& counts) {
  for (const Missed kind : {Missed::kPart, Missed::kCavity}) {
    const int64_t count = places.count[static_cast<size_t>(kind)];
    if (count == 0) continue;
    const Cutout cutout(object, places, kind);
    Mesh part;
    part.sizing = mesh.sizing;
    // A uniform one is made by voxels, and conform() learns delta: its bits are recorded.
    if (part.sizing != nullptr) part.delta = mesh.delta;
    part.inside_out = kind == Missed::kCavity;
    if (Status s = regular_iso_surface(cutout.object(), cutout.values(), schedule, part); !s.ok()) {
      return s;
    }
    Status s = conform(part, mesh.delta, schedule, counts);
    if (part.vertex_count() == 0) continue;  // nothing is left of it
    if (!s.ok()) return s;
    (kind == Missed::kPart ? started.bubbles : started.cavities) += count;
    started.volume += volume_of(part, schedule);
    append_mesh(mesh, part, part.inside_out, [](Vec3 p) { return p; });
  }
  return {};
}

}  // namespace plc
