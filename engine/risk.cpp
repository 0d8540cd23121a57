#include "engine/risk.h"

#include <algorithm>
#include <array>

#include "engine/constants.h"
#include "engine/edge.h"

namespace plc {

namespace {

struct Extent {
  float low, high;
};

struct Face {
  std::array<Vec3, 3> corner;
  std::array<uint32_t, 3> id;
  Vec3 normal, centre;

  Extent along(Vec3 axis) const {
    const float a = dot(corner[0], axis), b = dot(corner[1], axis), c = dot(corner[2], axis);
    return {std::min({a, b, c}), std::max({a, b, c})};
  }
  bool shares_vertex(const Face& o) const {
    bool common = false;
    for (const uint32_t i : id) common |= (i == o.id[0]) | (i == o.id[1]) | (i == o.id[2]);
    return common;
  }
};

Vec3 unit(Vec3 a) {
  const float norm = length(a);
  return norm > 0 ? a * (1.0F / norm) : Vec3{};
}

constexpr uint32_t kMaxFaces = 32;

// The faces around a vertex and the whole of them.
struct Star {
  std::array<Face, kMaxFaces> faces;
  uint32_t size;

  Star(const Mesh& mesh, uint32_t v, const Neighbors& ring) : size(ring.size()) {
    const Vec3 p = mesh.at(v);
    for (uint32_t k = 0; k < size; ++k) {
      Face& f = faces[k];
      f.id = {v, ring[k], ring.next(k)};
      f.corner = {p, mesh.at(f.id[1]), mesh.at(f.id[2])};
      f.normal = unit(area_vector(f.corner[0], f.corner[1], f.corner[2]));
      f.centre = (f.corner[0] + f.corner[1] + f.corner[2]) * (1.0F / 3.0F);
    }
  }
};

bool apart(Extent a, Extent b, float gap) {
  return b.low - a.high >= gap || a.low - b.high >= gap;
}

// A plane across the normal of either, or across the line between their centres.
bool faces_apart(const Face& f, const Face& g, float gap) {
  for (const Vec3 axis : {f.normal, g.normal}) {
    if (apart(f.along(axis), g.along(axis), gap)) return true;
  }
  const Vec3 axis = unit(g.centre - f.centre);
  return apart(f.along(axis), g.along(axis), gap);
}

Extent extent_of(const Mesh& mesh, uint32_t centre, const Neighbors& ring, Vec3 axis) {
  Extent e{dot(mesh.at(centre), axis), 0};
  e.high = e.low;
  for (const uint32_t x : ring) {
    const float at = dot(mesh.at(x), axis);
    e.low = std::min(e.low, at);
    e.high = std::max(e.high, at);
  }
  return e;
}

}  // namespace

bool folded(const Mesh& mesh, uint32_t v, const Neighbors& ring) {
  const Vec3 p = mesh.at(v);
  const Vec3 n = mesh.normal.at(v);
  for (uint32_t k = 0; k < ring.size(); ++k) {
    const Vec3 area = area_vector(p, mesh.at(ring[k]), mesh.at(ring.next(k)));
    if (dot(area, n) <= kRiskDot * length(area)) return true;
  }
  return false;
}

bool may_meet(const Mesh& mesh, uint32_t v, const Neighbors& ring, uint32_t w) {
  const float gap = kRiskGap * static_cast<float>(mesh.delta);
  const Neighbors other = mesh.ring(w);
  // The cheapest first: one plane for all of their faces.
  for (const Vec3 axis : {mesh.normal.at(v), mesh.normal.at(w)}) {
    if (apart(extent_of(mesh, v, ring, axis), extent_of(mesh, w, other, axis), gap)) return false;
  }
  if (ring.size() > kMaxFaces || other.size() > kMaxFaces) return true;
  const Star of_v(mesh, v, ring), of_w(mesh, w, other);
  for (uint32_t i = 0; i < of_v.size; ++i) {
    for (uint32_t k = 0; k < of_w.size; ++k) {
      const Face& f = of_v.faces[i];
      const Face& g = of_w.faces[k];
      if (!f.shares_vertex(g) && !faces_apart(f, g, gap)) return true;
    }
  }
  return false;
}

}  // namespace plc
