#include "tools/render/render_camera.h"

#include <algorithm>

namespace plc::tools {

namespace {

constexpr double kHalfAngle = 9.0;  // degrees: a mild perspective
constexpr float kMargin = 1.06F;    // of the picture around the mesh

float radians(double degrees) {
  return static_cast<float>(degrees * 3.14159265358979 / 180);
}

}  // namespace

Camera::Camera(const View& view, const std::vector<Vec3f>& points) {
  const float a = radians(view.azimuth);
  const float e = radians(view.elevation);
  back = {std::sin(a) * std::cos(e), -std::cos(a) * std::cos(e), std::sin(e)};
  up = {-std::sin(a) * std::sin(e), std::cos(a) * std::sin(e), std::cos(e)};
  right = cross(up, back);
  tangent = std::tan(radians(kHalfAngle));

  Vec3f low = {INFINITY, INFINITY, INFINITY};
  Vec3f high = {-INFINITY, -INFINITY, -INFINITY};
  for (const Vec3f p : points) {
    const Vec3f q = {dot(p, right), dot(p, up), dot(p, back)};
    low = {std::min(low.x, q.x), std::min(low.y, q.y), std::min(low.z, q.z)};
    high = {std::max(high.x, q.x), std::max(high.y, q.y), std::max(high.z, q.z)};
  }
  const Vec3f middle = (low + high) * 0.5F;
  float distance = 0;
  for (const Vec3f p : points) {
    const float x = std::abs(dot(p, right) - middle.x);
    const float y = std::abs(dot(p, up) - middle.y);
    distance = std::max(distance, dot(p, back) - middle.z + kMargin * std::max(x, y) / tangent);
  }
  eye = right * middle.x + up * middle.y + back * (middle.z + distance);
}

Vec3f Camera::direction(float u, float v) const {
  return normalised(right * (u * tangent) + up * (v * tangent) - back);
}

}  // namespace plc::tools
