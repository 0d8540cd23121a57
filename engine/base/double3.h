// Three doubles for measurements; every operation rounds once, in the order written.
#pragma once
#include <cmath>

namespace plc {

struct Double3 {
  double x = 0, y = 0, z = 0;
};

inline Double3 operator+(const Double3& a, const Double3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Double3 operator-(const Double3& a, const Double3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Double3 operator*(const Double3& a, double s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline double dot(const Double3& a, const Double3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(const Double3& a) {
  return std::sqrt(dot(a, a));
}

// Of two triples of coordinates: exact where they nearly coincide, wherever the origin is.
template <typename Real>
Double3 difference(const Real* p, const Real* q) {
  return {static_cast<double>(p[0]) - static_cast<double>(q[0]),
          static_cast<double>(p[1]) - static_cast<double>(q[1]),
          static_cast<double>(p[2]) - static_cast<double>(q[2])};
}

}  // namespace plc
