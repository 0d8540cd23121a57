#include "engine/risk.h"

#include <algorithm>
#include <array>

#include "engine/constants.h"
#include "engine/edge.h"

namespace plc {

namespace {

// Stars of larger valence are not looked at closely: at risk. One bit per vertex of a star.
constexpr uint32_t kMaxRing = 31;

// A vertex, number 0, and its ring. Face k has the numbers 0, k + 1 and the next one's.
struct Star {
  std::array<uint32_t, kMaxRing + 1> id;
  std::array<Vec3, kMaxRing + 1> at;
  uint32_t faces;

  Star(const Mesh& mesh, uint32_t v, const Neighbors& ring) : faces(ring.size()) {
    id[0] = v;
    at[0] = mesh.at(v);
    for (uint32_t k = 0; k < faces; ++k) {
      id[k + 1] = ring[k];
      at[k + 1] = mesh.at(ring[k]);
    }
  }
  uint32_t next(uint32_t k) const { return k + 1 == faces ? 1 : k + 2; }
};

struct Extent {
  float low, high;
};

bool apart(Extent a, Extent b, float gap) {
  return b.low - a.high >= gap || a.low - b.high >= gap;
}

// Where the vertices of a star lie along an axis.
struct Along {
  std::array<float, kMaxRing + 1> place;

  Along(const Star& star, Vec3 axis) {
    for (uint32_t k = 0; k <= star.faces; ++k) place[k] = dot(star.at[k], axis);
  }
  Extent of_all(const Star& star) const {
    Extent e{place[0], place[0]};
    for (uint32_t k = 1; k <= star.faces; ++k) {
      e.low = std::min(e.low, place[k]);
      e.high = std::max(e.high, place[k]);
    }
    return e;
  }
  Extent of_face(const Star& star, uint32_t k) const {
    const float a = place[0], b = place[k + 1], c = place[star.next(k)];
    return {std::min(std::min(a, b), c), std::max(std::max(a, b), c)};
  }
};

// An axis with both stars along it; `room` is the gap in its lengths, so that it need not be a unit
// vector.
struct Axis {
  Along v, w;
  float room;
  Axis(const Star& of_v, const Star& of_w, Vec3 axis, float gap)
      : v(of_v, axis), w(of_w, axis), room(gap * length(axis)) {}
};

// The vertices of `star` that face k has, as bits.
uint32_t face_bits(const Star& star, uint32_t k) {
  return 1U | 1U << (k + 1) | 1U << star.next(k);
}

// For each vertex of `star`, the bit of the same vertex in `other`, if any.
std::array<uint32_t, kMaxRing + 1> common_bits(const Star& star, const Star& other) {
  std::array<uint32_t, kMaxRing + 1> bits;
  for (uint32_t k = 0; k <= star.faces; ++k) {
    bits[k] = 0;
    for (uint32_t i = 0; i <= other.faces; ++i) {
      bits[k] |= static_cast<uint32_t>(star.id[k] == other.id[i]) << i;
    }
  }
  return bits;
}

// A plane across the normal of face k of `f` with room between it and face i of `g`.
bool face_plane_apart(const Star& f, uint32_t k, const Star& g, uint32_t i, float gap) {
  const Vec3 normal = area_vector(f.at[0], f.at[k + 1], f.at[f.next(k)]);
  const float at = dot(f.at[0], normal), room = gap * length(normal);
  const float a = dot(g.at[0], normal) - at, b = dot(g.at[i + 1], normal) - at,
              c = dot(g.at[g.next(i)], normal) - at;
  return std::min(std::min(a, b), c) >= room || std::max(std::max(a, b), c) <= -room;
}

bool centres_apart(const Star& f, uint32_t k, const Star& g, uint32_t i, float gap) {
  const std::array<Vec3, 3> p{f.at[0], f.at[k + 1], f.at[f.next(k)]};
  const std::array<Vec3, 3> q{g.at[0], g.at[i + 1], g.at[g.next(i)]};
  const Vec3 axis = q[0] + q[1] + q[2] - p[0] - p[1] - p[2];
  const auto extent = [&](const std::array<Vec3, 3>& t) {
    const float a = dot(t[0], axis), b = dot(t[1], axis), c = dot(t[2], axis);
    return Extent{std::min(std::min(a, b), c), std::max(std::max(a, b), c)};
  };
  return apart(extent(p), extent(q), gap * length(axis));
}

}  // namespace

bool may_meet(const Mesh& mesh, uint32_t v, const Neighbors& ring, uint32_t w) {
  const float gap = kRiskGap * static_cast<float>(mesh.delta);
  const Neighbors other = mesh.ring(w);
  if (ring.size() > kMaxRing || other.size() > kMaxRing) return true;
  const Star of_v(mesh, v, ring), of_w(mesh, w, other);
  // The cheapest first: one plane for all faces of both.
  const Axis first(of_v, of_w, mesh.normal.at(v), gap);
  if (apart(first.v.of_all(of_v), first.w.of_all(of_w), first.room)) return false;
  const Axis second(of_v, of_w, mesh.normal.at(w), gap);
  if (apart(second.v.of_all(of_v), second.w.of_all(of_w), second.room)) return false;
  // Then pairs of faces.
  const Axis between(of_v, of_w, of_w.at[0] - of_v.at[0], gap);
  const auto common = common_bits(of_v, of_w);
  for (uint32_t k = 0; k < of_v.faces; ++k) {
    const uint32_t shared = common[0] | common[k + 1] | common[of_v.next(k)];
    for (uint32_t i = 0; i < of_w.faces; ++i) {
      if ((shared & face_bits(of_w, i)) != 0) continue;
      const auto axis_apart = [&](const Axis& a) {
        return apart(a.v.of_face(of_v, k), a.w.of_face(of_w, i), a.room);
      };
      if (axis_apart(between) || axis_apart(first) || axis_apart(second) ||
          face_plane_apart(of_v, k, of_w, i, gap) || face_plane_apart(of_w, i, of_v, k, gap) ||
          centres_apart(of_v, k, of_w, i, gap)) {
        continue;
      }
      return true;
    }
  }
  return false;
}

}  // namespace plc
