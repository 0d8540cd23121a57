// Sample directions that depend on nothing but the pixel and the sample's number.
#pragma once
#include <cmath>
#include <cstdint>

#include "tools/render/render_camera.h"

namespace plc::tools {

// An integer hash (Wang's), as a number in [0, 1).
inline float hashed(uint32_t x) {
  x = (x ^ 61U) ^ (x >> 16U);
  x *= 9U;
  x ^= x >> 4U;
  x *= 0x27d4eb2dU;
  x ^= x >> 15U;
  return static_cast<float>(x >> 8U) * (1.0F / 16777216.0F);
}

// Sample `index` of `count` over the hemisphere about n, denser where the cosine is larger. The
// samples of a pixel lie on a golden-angle spiral that is turned from pixel to pixel.
inline Vec3f cosine_direction(Vec3f n, uint32_t pixel, uint32_t index, uint32_t count) {
  constexpr float kGoldenAngle = 2.39996323F;
  constexpr float kTurn = 6.28318531F;
  const float offset = hashed(2 * pixel + 1);
  const float square = (static_cast<float>(index) + offset) / static_cast<float>(count);
  const float angle = kGoldenAngle * static_cast<float>(index) + kTurn * hashed(2 * pixel);
  const float radius = std::sqrt(square);
  const float height = std::sqrt(1 - square);
  // A frame about n without a branch that could divide by zero: Duff et al. 2017.
  const float sign = std::copysign(1.0F, n.z);
  const float a = -1 / (sign + n.z);
  const float b = n.x * n.y * a;
  const Vec3f s = {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
  const Vec3f t = {b, sign + n.y * n.y * a, -n.y};
  return s * (radius * std::cos(angle)) + t * (radius * std::sin(angle)) + n * height;
}

}  // namespace plc::tools
