#include "engine/late_bubbles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/conform.h"
#include "engine/constants.h"
#include "engine/iso_surface.h"
#include "engine/measures.h"
#include "engine/mesh_append.h"
#include "engine/missed_places.h"

namespace plc {

namespace {

// The part of the image around the places of one kind, with everything else turned to the other
// side of iso.
class Cutout {
 public:
  Cutout(const ImageView& image, float iso, bool above, const MissedPlaces& places, Missed kind) {
    const auto k = static_cast<size_t>(kind);
    const auto& low = places.low[k];
    view_ = image;
    for (size_t a = 0; a < 3; ++a) {
      // The places end a voxel from the border of the cutout: what is beyond is outside.
      view_.dims[a] = places.high[k][a] - low[a] + 3;
      view_.offset[a] = image.offset[a] - static_cast<float>(low[a] - 1);
    }
    values_.resize(static_cast<size_t>(view_.dims[0]) * static_cast<size_t>(view_.dims[1]) *
                   static_cast<size_t>(view_.dims[2]));
    size_t to = 0;
    for (int32_t z = low[2] - 1; z < low[2] - 1 + view_.dims[2]; ++z) {
      for (int32_t y = low[1] - 1; y < low[1] - 1 + view_.dims[1]; ++y) {
        for (int32_t x = low[0] - 1; x < low[0] - 1 + view_.dims[0]; ++x) {
          values_[to++] = value({x, y, z}, image, iso, above, places, kind);
        }
      }
    }
    view_.data = values_.data();
  }
  const ImageView& view() const { return view_; }

 private:
  // How far a voxel lies on the object's side of iso, for parts; on the other, for cavities.
  static float value(const std::array<int32_t, 3>& v, const ImageView& image, float iso, bool above,
                     const MissedPlaces& places, Missed kind) {
    for (size_t a = 0; a < 3; ++a) {
      if (v[a] < 0 || v[a] >= image.dims[a]) return -1;
    }
    const size_t i = voxel_index(image, v);
    const bool up = above == (kind == Missed::kPart);
    const float depth = up ? image.data[i] - iso : iso - image.data[i];
    return places.is(i, kind) ? std::max(depth, 0.0F) : -std::max(std::abs(depth), kLeast);
  }

  static constexpr float kLeast = 1e-6F;
  ImageView view_;
  std::vector<float> values_;
};

double volume_of(const Mesh& mesh, const Executor& executor) {
  std::vector<float> xyz;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    const Vec3 p = mesh.at(v);
    xyz.insert(xyz.end(), {p.x, p.y, p.z});
  }
  const std::vector<uint32_t> faces = mesh.faces();
  return surface_measures(xyz.data(), mesh.slots(), faces.data(), faces.size() / 3, executor)
      .volume;
}

}  // namespace

Status start_late_bubbles(const ImageView& image, float iso, bool inside_above,
                          const Schedule& schedule, SimdTarget simd, Mesh& mesh,
                          Buffer<uint8_t>& tried, LateBubbles& started, OperationCounts& counts) {
  const auto delta = static_cast<float>(mesh.delta);
  // A vertex of an iso-surface lies at most 0.9 of a voxel's diagonal from a voxel of the place.
  float diagonal = 0;
  for (const float scale : image.scale) diagonal += 1 / (scale * scale);
  const float clearance = kBubbleGap * delta + 0.9F * std::sqrt(diagonal);
  const MissedPlaces places = find_missed_places(mesh, image, iso, inside_above, clearance,
                                                 kSmallestBubble * delta, schedule, tried);
  for (const Missed kind : {Missed::kPart, Missed::kCavity}) {
    const int64_t count = places.count[static_cast<size_t>(kind)];
    if (count == 0) continue;
    const Cutout cutout(image, iso, inside_above, places, kind);
    Mesh part;
    if (Status s = iso_surface(cutout.view(), 0, true, schedule, part); !s.ok()) return s;
    Status s = conform(part, mesh.delta, schedule, simd, counts);
    if (s.code() == ErrorCode::kInvalidData) continue;  // nothing is left of it
    if (!s.ok()) return s;
    (kind == Missed::kPart ? started.bubbles : started.cavities) += count;
    started.volume += volume_of(part, schedule);
    append_mesh(mesh, part, kind == Missed::kCavity, [](Vec3 p) { return p; });
  }
  return {};
}

}  // namespace plc
