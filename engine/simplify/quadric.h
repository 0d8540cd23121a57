// The sum of squared distances to planes, as a function of the place.
//   M. Garland, P. S. Heckbert, "Surface Simplification Using Quadric Error Metrics", SIGGRAPH
//   1997.
#pragma once
#include <cmath>

#include "engine/base/double3.h"

namespace plc {

// x^T A x + 2 b^T x + c over the planes of faces, each weighted by its area; 88 bytes.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  double bx = 0, by = 0, bz = 0;
  double c = 0;
  double weight = 0;  // sum of the areas

  void add(const Quadric& q) {
    xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
    bx += q.bx, by += q.by, bz += q.bz;
    c += q.c;
    weight += q.weight;
  }
  double at(const Double3& p) const {
    const double x = xx * p.x + xy * p.y + xz * p.z + 2 * bx;
    const double y = xy * p.x + yy * p.y + yz * p.z + 2 * by;
    const double z = xz * p.x + yz * p.y + zz * p.z + 2 * bz;
    return x * p.x + y * p.y + z * p.z + c;
  }
};

// Of the plane of a triangle, weighted by the triangle's area.
inline Quadric quadric_of(const Double3& p, const Double3& q, const Double3& r) {
  const Double3 area = cross(q - p, r - p);
  const double norm = length(area);
  if (!(norm > 0)) return {};
  const Double3 n = area * (1 / norm);
  const double d = -dot(n, p), w = norm / 2;
  return {w * n.x * n.x,
          w * n.x * n.y,
          w * n.x * n.z,
          w * n.y * n.y,
          w * n.y * n.z,
          w * n.z * n.z,
          w * n.x * d,
          w * n.y * d,
          w * n.z * d,
          w * d * d,
          w};
}

// Where the quadric, and `pull` of its weight times the squared distance from `from`, are least:
// with a small pull, where planes do not settle the place it is the nearest one that they leave.
inline Double3 least_of(const Quadric& q, const Double3& from, double pull) {
  const double w = pull * q.weight;
  const double a = q.xx + w, b = q.xy, c = q.xz, d = q.yy + w, e = q.yz, f = q.zz + w;
  const double gx = -(q.xx * from.x + q.xy * from.y + q.xz * from.z + q.bx);
  const double gy = -(q.xy * from.x + q.yy * from.y + q.yz * from.z + q.by);
  const double gz = -(q.xz * from.x + q.yz * from.y + q.zz * from.z + q.bz);
  // By the root-free Cholesky decomposition: the matrix is positive definite.
  const double l10 = b / a, l20 = c / a;
  const double d1 = d - l10 * b;
  const double u12 = e - l10 * c;
  const double l21 = u12 / d1;
  const double d2 = f - l20 * c - l21 * u12;
  const double y1 = gy - l10 * gx;
  const double y2 = gz - l20 * gx - l21 * y1;
  const double z = y2 / d2;
  const double y = y1 / d1 - l21 * z;
  const double x = gx / a - l10 * y - l20 * z;
  const Double3 step{x, y, z};
  return std::isfinite(x) && std::isfinite(y) && std::isfinite(z) ? from + step : from;
}

}  // namespace plc
