#include "engine/late_bubbles.h"

#include <algorithm>
#include <array>

#include "engine/conform.h"
#include "engine/constants.h"
#include "engine/iso_surface.h"
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
    const auto i = static_cast<size_t>((v[2] * image.dims[1] + v[1]) * image.dims[0] + v[0]);
    const bool up = above == (kind == Missed::kPart);
    const float depth = up ? image.data[i] - iso : iso - image.data[i];
    return places.is(i, kind) ? std::max(depth, 0.0F) : -std::max(std::abs(depth), kLeast);
  }

  static constexpr float kLeast = 1e-6F;
  ImageView view_;
  std::vector<float> values_;
};

void append(Mesh& mesh, const Mesh& part, bool inward) {
  std::vector<uint32_t> id(part.slots());
  for (uint32_t v = 0; v < part.slots(); ++v) {
    if (part.alive(v)) id[v] = mesh.create(part.at(v), {});
  }
  for (uint32_t v = 0; v < part.slots(); ++v) {
    if (!part.alive(v)) continue;
    const Neighbors from = part.ring(v);
    Neighbors ring;
    for (uint32_t n = 0; n < from.size(); ++n) {
      ring.push_back(id[from[inward ? from.size() - 1 - n : n]]);
    }
    mesh.set_ring(id[v], ring);
  }
}

// Six times the volume is the sum of the faces' determinants.
double volume_of(const Mesh& mesh) {
  const std::vector<uint32_t> faces = mesh.faces();
  double sum = 0;
  for (size_t i = 0; i < faces.size(); i += 3) {
    std::array<std::array<double, 3>, 3> p;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3 at = mesh.at(faces[i + k]);
      p[k] = {static_cast<double>(at.x), static_cast<double>(at.y), static_cast<double>(at.z)};
    }
    sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) +
           p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
           p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
  }
  return sum / 6;
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
    started.volume += volume_of(part);
    append(mesh, part, kind == Missed::kCavity);
  }
  return {};
}

}  // namespace plc
