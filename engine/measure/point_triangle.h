// The distance from a point to a triangle, of any shape down to a segment or a point.
#pragma once
#include <algorithm>

#include "engine/base/double3.h"

namespace plc {

// From the origin to the segment from a to b.
inline double squared_distance_to_segment(const Double3& a, const Double3& b) {
  const Double3 ab = b - a;
  const double along = -dot(a, ab), whole = dot(ab, ab);
  if (!(along > 0)) return dot(a, a);
  if (along >= whole) return dot(b, b);
  const Double3 foot = a + ab * (along / whole);
  return dot(foot, foot);
}

// Of three values each. Computed from the differences to p: no digits are lost far from the origin.
inline double squared_distance_to_triangle(const double* p, const double* a, const double* b,
                                           const double* c) {
  const Double3 u = difference(a, p), v = difference(b, p), w = difference(c, p);
  const Double3 normal = cross(difference(b, a), difference(c, a));
  const double square = dot(normal, normal);
  // Over the inside of the triangle the nearest point is the foot in its plane.
  if (square > 0 && dot(cross(u, v), normal) >= 0 && dot(cross(v, w), normal) >= 0 &&
      dot(cross(w, u), normal) >= 0) {
    const double height = dot(normal, u);
    return height / square * height;
  }
  return std::min(squared_distance_to_segment(u, v),
                  std::min(squared_distance_to_segment(v, w), squared_distance_to_segment(w, u)));
}

}  // namespace plc
