#include "engine/exact/vertex_star.h"

#include <algorithm>
#include <cmath>

namespace plc {

void Fan::add(const Vec3& place) {
  if (count_ < kMax) {
    const double x = static_cast<double>(place.x) - static_cast<double>(centre_.x);
    const double y = static_cast<double>(place.y) - static_cast<double>(centre_.y);
    const double z = static_cast<double>(place.z) - static_cast<double>(centre_.z);
    x_[count_] = x, y_[count_] = y, z_[count_] = z;
    longest_ = std::max(longest_, x * x + y * y + z * z);
  }
  ++count_;
}

bool Fan::is_embedded() {
  if (count_ < 3 || count_ > kMax) return false;
  x_[count_] = x_[0], y_[count_] = y_[0], z_[count_] = z_[0];
  double cx[kMax], cy[kMax], cz[kMax];
  double nx = 0, ny = 0, nz = 0;
  for (uint32_t k = 0; k < count_; ++k) {
    cx[k] = y_[k] * z_[k + 1] - z_[k] * y_[k + 1];
    cy[k] = z_[k] * x_[k + 1] - x_[k] * z_[k + 1];
    cz[k] = x_[k] * y_[k + 1] - y_[k] * x_[k + 1];
    nx += cx[k];
    ny += cy[k];
    nz += cz[k];
  }
  // det(n, e, e') is known to about 20 |n| |e| |e'| 2^-53; what is left of 1e-12 covers what the
  // roundings of the edges themselves and of winds_once may turn.
  const double doubt = 1e-12 * longest_ * (std::abs(nx) + std::abs(ny) + std::abs(nz));
  bool one_way = true;
  for (uint32_t k = 0; k < count_; ++k) {
    one_way &= cx[k] * nx + cy[k] * ny + cz[k] * nz > doubt;
  }
  return one_way && winds_once(nx, ny, nz);
}

// Whether the edges, each to the left of the one before it about n, go around n once. q is
// perpendicular to n exactly, so that q . e depends on the projection of e along n only; turning by
// less than half a circle at a time, the edges enter the side q . e >= 0 once per turn. Rounding of
// q . e is the same as moving e by as little; the turns have been found positive by more than that.
bool Fan::winds_once(double nx, double ny, double nz) const {
  const double ax = std::abs(nx), ay = std::abs(ny), az = std::abs(nz);
  double qx = ny, qy = -nx, qz = 0;
  if (az >= std::min(ax, ay)) {
    qx = ax >= ay ? nz : 0;
    qy = ax >= ay ? 0 : nz;
    qz = ax >= ay ? -nx : -ny;
  }
  uint32_t entries = 0;
  bool before = qx * x_[0] + qy * y_[0] + qz * z_[0] >= 0;
  for (uint32_t k = 1; k <= count_; ++k) {
    const bool now = qx * x_[k] + qy * y_[k] + qz * z_[k] >= 0;
    entries += static_cast<uint32_t>(now && !before);
    before = now;
  }
  return entries == 1;
}

bool fan_is_embedded(const Vec3& centre, const Vec3* ring, size_t count) {
  Fan fan(centre);
  for (size_t k = 0; k < count; ++k) fan.add(ring[k]);
  return fan.is_embedded();
}

bool star_is_embedded(const RingView& rings, const Float4* positions, uint32_t v) {
  const auto at = [&](uint32_t u) { return Vec3{positions[u].x, positions[u].y, positions[u].z}; };
  Fan fan(at(v));
  const uint32_t count = rings.valence[v];
  for (uint32_t k = 0; k < count; ++k) fan.add(at(rings.slot(v, k)));
  return fan.is_embedded();
}

}  // namespace plc
