#include "engine/detect/risk.h"

#include <algorithm>
#include <array>
#include <bit>

#include "engine/base/constants.h"
#include "engine/base/four.h"
#include "engine/transform/edge.h"

namespace plc {

namespace {

using Extent = RiskStar::Extent;
using Stream = RiskStar::Stream;

bool apart(Extent a, Extent b, float gap) {
  return b.low - a.high >= gap || a.low - b.high >= gap;
}

// Where the faces of a star lie along an axis, filled up as the star is.
struct FaceExtents {
  FaceExtents(const RiskStar& star, const Stream& along) {
    const Four centre = Four{} + along[0];
    for (uint32_t k = 0; k < star.padded; k += 4) {
      const Four a = load_four(&along[k + 1]), b = load_four(&along[k + 2]);
      store_four(min_four(min_four(centre, a), b), &low[k]);
      store_four(max_four(max_four(centre, a), b), &high[k]);
    }
    const uint32_t last = star.faces - 1;
    low[last] = std::min(std::min(along[0], along[star.faces]), along[1]);
    high[last] = std::max(std::max(along[0], along[star.faces]), along[1]);
  }

  Stream low, high;
};

// The faces of two stars along an axis.
struct Axis {
  // Of the faces of w from i on, those with room between them and face k of v.
  FourInts apart(uint32_t k, uint32_t i) const {
    return (load_four(&w.low[i]) - v.high[k] >= room) | (v.low[k] - load_four(&w.high[i]) >= room);
  }

  FaceExtents v, w;
  float room;
};

// Of the faces of `star` those that have this vertex, as bits.
uint32_t faces_with(const RiskStar& star, uint32_t id) {
  uint32_t vertices = 0;
  for (uint32_t k = 0; k < star.padded; k += 4) {
    vertices |= lane_bits(load_four(&star.id[k]) == static_cast<int32_t>(id)) << k;
  }
  if ((vertices & 1) != 0) return ~0U;
  const uint32_t in_ring = vertices >> 1;  // the first vertices of faces
  return in_ring | in_ring >> 1 | (in_ring & 1) << (star.faces - 1);
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
    : faces(mesh.valence(v)), padded(faces / 4 * 4 + 4) {
  const auto set = [&](uint32_t k, uint32_t w) {
    const Float4& p = mesh.position[w];
    id[k] = w, x[k] = p.x, y[k] = p.y, z[k] = p.z;
  };
  set(0, v);
  for (uint32_t k = 0; k < faces; ++k) set(k + 1, mesh.neighbor(v, k));
  for (uint32_t k = faces + 1; k < padded; ++k) id[k] = v, x[k] = x[0], y[k] = y[0], z[k] = z[0];
}

Stream RiskStar::along(Vec3 axis) const {
  Stream along;
  for (uint32_t k = 0; k < padded; k += 4) {
    store_four(load_four(&x[k]) * axis.x + load_four(&y[k]) * axis.y + load_four(&z[k]) * axis.z,
               &along[k]);
  }
  store_four(Four{}, &along[padded]);
  return along;
}

Extent RiskStar::extent(const Stream& along) const {
  Four low = load_four(along.data()), high = low;
  for (uint32_t k = 4; k < padded; k += 4) {
    low = min_four(low, load_four(&along[k]));
    high = max_four(high, load_four(&along[k]));
  }
  return {std::min(std::min(low[0], low[1]), std::min(low[2], low[3])),
          std::max(std::max(high[0], high[1]), std::max(high[2], high[3]))};
}

Risk::Risk(const Mesh& mesh, uint32_t v)
    : mesh_(mesh),
      steps_(steps_around(mesh, v)),
      star_(mesh, v),
      normal_(mesh.normal.at(v)),
      along_(star_.along(normal_)),
      extent_(star_.extent(along_)) {}

bool Risk::may_meet(uint32_t w) const {
  if (mesh_.valence(w) > kRiskRing) return true;
  const float gap =
      kRiskGap * static_cast<float>(mesh_.delta) * std::max(steps_, steps_around(mesh_, w));
  const RiskStar of_w(mesh_, w);
  // The cheapest first: one plane for all faces of both.
  const Stream first = of_w.along(normal_);
  const float first_room = gap * length(normal_);
  if (apart(extent_, of_w.extent(first), first_room)) return false;
  const Vec3 normal = mesh_.normal.at(w);
  const Stream second_v = star_.along(normal), second_w = of_w.along(normal);
  const float second_room = gap * length(normal);
  if (apart(star_.extent(second_v), of_w.extent(second_w), second_room)) return false;
  // Pair by pair.
  const Vec3 between = of_w.at(0) - star_.at(0);
  const Axis axes[3] = {
      {{star_, star_.along(between)}, {of_w, of_w.along(between)}, gap * length(between)},
      {{star_, along_}, {of_w, first}, first_room},
      {{star_, second_v}, {of_w, second_w}, second_room}};
  std::array<uint32_t, kRiskRing + 1> common;
  for (uint32_t k = 0; k <= star_.faces; ++k) common[k] = faces_with(of_w, star_.id[k]);
  const uint32_t all = (1U << of_w.faces) - 1;
  for (uint32_t k = 0; k < star_.faces; ++k) {
    uint32_t near = 0;
    for (uint32_t i = 0; i < of_w.padded; i += 4) {
      near |= lane_bits(axes[0].apart(k, i) | axes[1].apart(k, i) | axes[2].apart(k, i)) << i;
    }
    near = all & ~(near | common[0] | common[k + 1] | common[star_.next(k)]);
    for (; near != 0; near &= near - 1) {
      const auto i = static_cast<uint32_t>(std::countr_zero(near));
      if (!face_plane_apart(star_, k, of_w, i, gap) && !face_plane_apart(of_w, i, star_, k, gap) &&
          !centres_apart(star_, k, of_w, i, gap)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace plc
