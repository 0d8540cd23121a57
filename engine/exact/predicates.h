// Exact signs of orientation determinants: a floating-point filter, then expansion arithmetic.
// J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates", Discrete & Computational Geometry 18, 1997.
//
// The signs are those of the exact determinants of the given doubles as long as every coordinate is
// 0 or within 1e-90 <= |x| <= 1e90: below, the last bits of a product of three could underflow,
// above, the product could overflow. Every finite float is within (1.4e-45 .. 3.4e38). Rounding is
// to nearest even (the default) in double (no x87); no state, no initialisation; thread-safe.
#pragma once
#include <cmath>

namespace plc {

struct Point3 {
  double x, y, z;
};

inline constexpr double kPredicateMin = 1e-90;
inline constexpr double kPredicateMax = 1e90;

// What the filters fall back to.
int orient3d_exact(const Point3& a, const Point3& b, const Point3& c, const Point3& d);
int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy);

// With u = 2^-53 the rounding unit: each term of the 3x3 determinant passes through at most 8
// roundings (three differences, two products, one difference of products, two sums), so that its
// error is at most ((1 + u)^8 - 1) times its magnitude; the sum of the magnitudes ("permanent") is
// itself computed with at most as many. 8 u plus terms of u^2 < 9 u.
inline constexpr double kOrient3dBound = 9.0 / 9007199254740992.0;
// Likewise with two differences, one product and one difference: 4 u plus terms of u^2 < 5 u.
inline constexpr double kOrient2dBound = 5.0 / 9007199254740992.0;

// The plane through a, b, c, for asking the side of several points.
class Plane {
 public:
  Plane(const Point3& a, const Point3& b, const Point3& c) : a_(a), b_(b), c_(c) {
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double yz = uy * vz, zy = uz * vy, zx = uz * vx, xz = ux * vz, xy = ux * vy, yx = uy * vx;
    nx_ = yz - zy, ny_ = zx - xz, nz_ = xy - yx;
    mx_ = std::abs(yz) + std::abs(zy);
    my_ = std::abs(zx) + std::abs(xz);
    mz_ = std::abs(xy) + std::abs(yx);
  }
  // The sign (-1, 0, 1) of det(b - a, c - a, d - a): 1 on the side from which a, b, c run
  // counter-clockwise; 0 exactly when the four points are coplanar.
  int side(const Point3& d) const {
    const double x = d.x - a_.x, y = d.y - a_.y, z = d.z - a_.z;
    const double det = x * nx_ + y * ny_ + z * nz_;
    const double permanent = std::abs(x) * mx_ + std::abs(y) * my_ + std::abs(z) * mz_;
    const double bound = kOrient3dBound * permanent;
    if (det > bound) return 1;
    if (det < -bound) return -1;
    if (permanent == 0) return 0;  // every product is 0: points that coincide, axis-parallel planes
    return orient3d_exact(a_, b_, c_, d);
  }

 private:
  Point3 a_, b_, c_;
  double nx_, ny_, nz_;  // (b - a) x (c - a)
  double mx_, my_, mz_;  // magnitudes of what nx_, ny_, nz_ are differences of
};

// The sign (-1, 0, 1) of det(b - a, c - a, d - a).
inline int orient3d(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  return Plane(a, b, c).side(d);
}

// The sign (-1, 0, 1) of det(b - a, c - a): 1 when a, b, c turn counter-clockwise.
inline int orient2d(double ax, double ay, double bx, double by, double cx, double cy) {
  const double left = (bx - ax) * (cy - ay);
  const double right = (by - ay) * (cx - ax);
  const double det = left - right;
  const double permanent = std::abs(left) + std::abs(right);
  const double bound = kOrient2dBound * permanent;
  if (det > bound) return 1;
  if (det < -bound) return -1;
  if (permanent == 0) return 0;
  return orient2d_exact(ax, ay, bx, by, cx, cy);
}

// Whether a, b, c lie on a line: a triangle of exactly zero area.
bool collinear(const Point3& a, const Point3& b, const Point3& c);

}  // namespace plc
