// The camera of a picture, and the little algebra that pictures need.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "tools/render/render.h"

namespace plc::tools {

struct Vec3f {
  float x = 0, y = 0, z = 0;
};

inline Vec3f operator+(Vec3f a, Vec3f b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3f operator-(Vec3f a, Vec3f b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3f operator*(Vec3f a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}
inline float dot(Vec3f a, Vec3f b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3f cross(Vec3f a, Vec3f b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vec3f normalised(Vec3f a) {
  const float length = std::sqrt(dot(a, a));
  return length > 0 ? a * (1 / length) : a;
}

// A pinhole far enough away to see every point.
struct Camera {
  Vec3f eye;
  Vec3f right, up, back;  // orthonormal; it looks along -back
  float tangent;          // of half the angle of view

  Camera(const View& view, const std::vector<Vec3f>& points);

  // Of the ray through (u, v) in [-1, 1]^2, v upwards; unit.
  Vec3f direction(float u, float v) const;
};

}  // namespace plc::tools
