#include "engine/detect/risk.h"

#include <algorithm>
#include <array>

#include "engine/base/constants.h"
#include "engine/transform/edge.h"

namespace plc {

namespace {

using Extent = RiskStar::Extent;
using Stream = RiskStar::Stream;

bool apart(Extent a, Extent b, float gap) {
  return b.low - a.high >= gap || a.low - b.high >= gap;
}

Extent extent_of_face(const RiskStar& star, const Stream& along, uint32_t k) {
  const float a = along[0], b = along[k + 1], c = along[star.next(k)];
  return {std::min(std::min(a, b), c), std::max(std::max(a, b), c)};
}

// The vertices of `star` that face k has, as bits.
uint32_t face_bits(const RiskStar& star, uint32_t k) {
  return 1U | 1U << (k + 1) | 1U << star.next(k);
}

// For each vertex of `star`, the bit of the same vertex in `other`, if any.
std::array<uint32_t, kRiskRing + 1> common_bits(const RiskStar& star, const RiskStar& other) {
  std::array<uint32_t, kRiskRing + 1> bits;
  for (uint32_t k = 0; k <= star.faces; ++k) {
    bits[k] = 0;
    for (uint32_t i = 0; i <= other.faces; ++i) {
      bits[k] |= static_cast<uint32_t>(star.id[k] == other.id[i]) << i;
    }
  }
  return bits;
}

// A plane across the normal of face k of `f` with room between it and face i of `g`.
bool face_plane_apart(const RiskStar& f, uint32_t k, const RiskStar& g, uint32_t i, float gap) {
  const Vec3 normal = area_vector(f.at(0), f.at(k + 1), f.at(f.next(k)));
  const float at = dot(f.at(0), normal), room = gap * length(normal);
  const float a = dot(g.at(0), normal) - at, b = dot(g.at(i + 1), normal) - at,
              c = dot(g.at(g.next(i)), normal) - at;
  return std::min(std::min(a, b), c) >= room || std::max(std::max(a, b), c) <= -room;
}

bool centres_apart(const RiskStar& f, uint32_t k, const RiskStar& g, uint32_t i, float gap) {
  const std::array<Vec3, 3> p{f.at(0), f.at(k + 1), f.at(f.next(k))};
  const std::array<Vec3, 3> q{g.at(0), g.at(i + 1), g.at(g.next(i))};
  const Vec3 axis = q[0] + q[1] + q[2] - p[0] - p[1] - p[2];
  const auto extent = [&](const std::array<Vec3, 3>& t) {
    const float a = dot(t[0], axis), b = dot(t[1], axis), c = dot(t[2], axis);
    return Extent{std::min(std::min(a, b), c), std::max(std::max(a, b), c)};
  };
  return apart(extent(p), extent(q), gap * length(axis));
}

// What vertices of the faces around v move between two checks, as a part of what is usual: where
// the mesh is finer than delta movements are, too.
float steps_around(const Mesh& mesh, uint32_t v) {
  if (mesh.sizing == nullptr) return 1;
  return std::min(1.0F, (1 + mesh.position[v].w) * (1 + kMaxEdge * mesh.sizing->field.slope()));
}

}  // namespace

RiskStar::RiskStar(const Mesh& mesh, uint32_t v)
    : faces(mesh.valence(v)), padded(faces / kLanes * kLanes + kLanes) {
  const auto set = [&](uint32_t k, uint32_t w) {
    const Float4& p = mesh.position[w];
    id[k] = w, x[k] = p.x, y[k] = p.y, z[k] = p.z;
  };
  set(0, v);
  for (uint32_t k = 0; k < faces; ++k) set(k + 1, mesh.neighbor(v, k));
  for (uint32_t k = faces + 1; k < padded; ++k) x[k] = x[0], y[k] = y[0], z[k] = z[0];
}

Stream RiskStar::along(Vec3 axis) const {
  Stream along;
  for (uint32_t k = 0; k < padded; k += kLanes) {
    for (uint32_t l = k; l < k + kLanes; ++l) {
      along[l] = x[l] * axis.x + y[l] * axis.y + z[l] * axis.z;
    }
  }
  return along;
}

Extent RiskStar::extent(const Stream& along) const {
  float low[kLanes], high[kLanes];
  for (uint32_t l = 0; l < kLanes; ++l) low[l] = high[l] = along[l];
  for (uint32_t k = kLanes; k < padded; k += kLanes) {
    for (uint32_t l = 0; l < kLanes; ++l) {
      low[l] = std::min(low[l], along[k + l]);
      high[l] = std::max(high[l], along[k + l]);
    }
  }
  Extent e{low[0], high[0]};
  for (uint32_t l = 1; l < kLanes; ++l) {
    e.low = std::min(e.low, low[l]);
    e.high = std::max(e.high, high[l]);
  }
  return e;
}

Risk::Risk(const Mesh& mesh, uint32_t v)
    : mesh_(mesh),
      gap_(kRiskGap * static_cast<float>(mesh.delta) * steps_around(mesh, v)),
      star_(mesh, v),
      normal_(mesh.normal.at(v)),
      along_(star_.along(normal_)),
      extent_(star_.extent(along_)),
      room_(gap_ * length(normal_)) {}

bool Risk::may_meet(uint32_t w) const {
  if (mesh_.valence(w) > kRiskRing) return true;
  const RiskStar of_w(mesh_, w);
  // The cheapest first: one plane for all faces of both.
  const Stream first = of_w.along(normal_);
  if (apart(extent_, of_w.extent(first), room_)) return false;
  const Vec3 normal = mesh_.normal.at(w);
  const Stream second_v = star_.along(normal), second_w = of_w.along(normal);
  const float room = gap_ * length(normal);
  if (apart(star_.extent(second_v), of_w.extent(second_w), room)) return false;
  return faces_may_meet(of_w, first, second_v, second_w, room);
}

// Pair by pair.
bool Risk::faces_may_meet(const RiskStar& of_w, const Stream& first, const Stream& second_v,
                          const Stream& second_w, float second_room) const {
  const Vec3 between = of_w.at(0) - star_.at(0);
  const Stream between_v = star_.along(between), between_w = of_w.along(between);
  const float between_room = gap_ * length(between);
  const auto common = common_bits(star_, of_w);
  for (uint32_t k = 0; k < star_.faces; ++k) {
    const uint32_t shared = common[0] | common[k + 1] | common[star_.next(k)];
    for (uint32_t i = 0; i < of_w.faces; ++i) {
      if ((shared & face_bits(of_w, i)) != 0) continue;
      const auto axis_apart = [&](const Stream& v, const Stream& w, float room) {
        return apart(extent_of_face(star_, v, k), extent_of_face(of_w, w, i), room);
      };
      if (axis_apart(between_v, between_w, between_room) || axis_apart(along_, first, room_) ||
          axis_apart(second_v, second_w, second_room) ||
          face_plane_apart(star_, k, of_w, i, gap_) || face_plane_apart(of_w, i, star_, k, gap_) ||
          centres_apart(star_, k, of_w, i, gap_)) {
        continue;
      }
      return true;
    }
  }
  return false;
}

}  // namespace plc
