#include "engine/vertex_star.h"

#include <algorithm>
#include <cmath>

namespace plc {
namespace {

// Longer rings are left to the exact tests.
constexpr uint32_t kMaxRing = 32;

struct Edges {
  double x[kMaxRing + 1], y[kMaxRing + 1], z[kMaxRing + 1];
  double longest = 0;  // squared
  void set(size_t k, const Vec3& from, const Vec3& to) {
    x[k] = static_cast<double>(to.x) - static_cast<double>(from.x);
    y[k] = static_cast<double>(to.y) - static_cast<double>(from.y);
    z[k] = static_cast<double>(to.z) - static_cast<double>(from.z);
    longest = std::max(longest, x[k] * x[k] + y[k] * y[k] + z[k] * z[k]);
  }
};

// Whether the edges, each to the left of the one before it about n, go around n once. q is
// perpendicular to n exactly, so that q . e depends on the projection of e along n only; turning by
// less than half a circle at a time, the edges enter the side q . e >= 0 once per turn. Rounding of
// q . e is the same as moving e by as little; the turns have been found positive by more than that.
bool winds_once(const Edges& e, uint32_t count, double nx, double ny, double nz) {
  const double ax = std::abs(nx), ay = std::abs(ny), az = std::abs(nz);
  double qx = ny, qy = -nx, qz = 0;
  if (az >= std::min(ax, ay)) {
    qx = ax >= ay ? nz : 0;
    qy = ax >= ay ? 0 : nz;
    qz = ax >= ay ? -nx : -ny;
  }
  uint32_t entries = 0;
  bool before = qx * e.x[0] + qy * e.y[0] + qz * e.z[0] >= 0;
  for (uint32_t k = 1; k <= count; ++k) {
    const bool now = qx * e.x[k] + qy * e.y[k] + qz * e.z[k] >= 0;
    entries += static_cast<uint32_t>(now && !before);
    before = now;
  }
  return entries == 1;
}

// The edges e[0 .. count - 1] from the centre.
bool edges_are_plain(Edges& e, uint32_t count) {
  e.x[count] = e.x[0];
  e.y[count] = e.y[0];
  e.z[count] = e.z[0];
  double cx[kMaxRing], cy[kMaxRing], cz[kMaxRing];
  double nx = 0, ny = 0, nz = 0;
  for (uint32_t k = 0; k < count; ++k) {
    cx[k] = e.y[k] * e.z[k + 1] - e.z[k] * e.y[k + 1];
    cy[k] = e.z[k] * e.x[k + 1] - e.x[k] * e.z[k + 1];
    cz[k] = e.x[k] * e.y[k + 1] - e.y[k] * e.x[k + 1];
    nx += cx[k];
    ny += cy[k];
    nz += cz[k];
  }
  // det(n, e, e') is known to about 20 |n| |e| |e'| 2^-53; what is left of 1e-12 covers what the
  // roundings of the edges themselves and of winds_once may turn.
  const double doubt = 1e-12 * e.longest * (std::abs(nx) + std::abs(ny) + std::abs(nz));
  bool plain = true;
  for (uint32_t k = 0; k < count; ++k) {
    plain &= cx[k] * nx + cy[k] * ny + cz[k] * nz > doubt;
  }
  return plain && winds_once(e, count, nx, ny, nz);
}

}  // namespace

bool fan_is_plain(const Vec3& centre, const Vec3* ring, size_t count) {
  if (count > kMaxRing || count < 3) return false;
  Edges e;
  for (size_t k = 0; k < count; ++k) e.set(k, centre, ring[k]);
  return edges_are_plain(e, static_cast<uint32_t>(count));
}

bool star_is_plain(const RingView& rings, const Packed* positions, uint32_t v) {
  const uint32_t count = rings.valence[v];
  if (count > kMaxRing || count < 3) return false;
  const Packed& p = positions[v];
  Edges e;
  for (uint32_t k = 0; k < count; ++k) {
    const Packed& q = positions[rings.slot(v, k)];
    e.set(k, {p.x, p.y, p.z}, {q.x, q.y, q.z});
  }
  return edges_are_plain(e, count);
}

}  // namespace plc
