// Scalar twins of kernels/integrate.h.
#include <cmath>

#include "kernels/lane_sum.h"
#include "kernels/scalar.h"

namespace plc::kernels::scalar {

namespace {

// One coordinate of one vertex; returns that coordinate of the next stage's position.
float rk4_coordinate(int stage, const Rk4Coefficients& c, float p, float v, float f, float& s,
                     float& d, float& a) {
  const float w = stage == 0 ? v : s;
  const float acceleration = (f - c.damping * w) * c.inverse_mass;
  if (stage == 3) {
    const float sixth = c.time_step / 6.0F;
    d = (d + w) * sixth;
    a = v + (a + acceleration) * sixth;
    return p;
  }
  d = stage == 0 ? w : d + (w + w);
  a = stage == 0 ? acceleration : a + (acceleration + acceleration);
  const float step = stage == 2 ? c.time_step : c.time_step * 0.5F;
  s = v + step * acceleration;
  return p + step * w;
}

float squared(float x, float y, float z) {
  return x * x + y * y + z * z;
}

void shorten(float longest, float& x, float& y, float& z) {
  const float length = std::sqrt(squared(x, y, z));
  if (!(length > longest)) return;
  const float scale = longest / length;
  x *= scale;
  y *= scale;
  z *= scale;
}

}  // namespace

void rk4_stage(int stage, const Rk4Coefficients& coefficients, const Rk4Streams& s, uint32_t begin,
               uint32_t end) {
  for (uint32_t i = begin; i < end; ++i) {
    const float x =
        rk4_coordinate(stage, coefficients, s.px[i], s.vx[i], s.fx[i], s.sx[i], s.dx[i], s.ax[i]);
    const float y =
        rk4_coordinate(stage, coefficients, s.py[i], s.vy[i], s.fy[i], s.sy[i], s.dy[i], s.ay[i]);
    const float z =
        rk4_coordinate(stage, coefficients, s.pz[i], s.vz[i], s.fz[i], s.sz[i], s.dz[i], s.az[i]);
    if (stage != 3) s.stage[i] = {x, y, z, 0.0F};
  }
}

float max_squared(const float* dx, const float* dy, const float* dz, uint32_t begin, uint32_t end) {
  float longest = 0;
  for (uint32_t i = begin; i < end; ++i) {
    const float length = squared(dx[i], dy[i], dz[i]);
    longest = length > longest ? length : longest;
  }
  return longest;
}

void clamp_movement(float max_length, float max_speed, float* dx, float* dy, float* dz, float* vx,
                    float* vy, float* vz, uint32_t begin, uint32_t end) {
  for (uint32_t i = begin; i < end; ++i) {
    shorten(max_length, dx[i], dy[i], dz[i]);
    shorten(max_speed, vx[i], vy[i], vz[i]);
  }
}

void move(const float* dx, const float* dy, const float* dz, float* px, float* py, float* pz,
          Packed* packed, float* path, uint32_t begin, uint32_t end) {
  for (uint32_t i = begin; i < end; ++i) {
    px[i] += dx[i];
    py[i] += dy[i];
    pz[i] += dz[i];
    packed[i] = {px[i], py[i], pz[i], 0.0F};
    path[i] += std::sqrt(squared(dx[i], dy[i], dz[i]));
  }
}

double normal_energy_sum(const float* dx, const float* dy, const float* dz, const float* nx,
                         const float* ny, const float* nz, uint32_t begin, uint32_t end) {
  double lane[kRingLanes] = {};
  for (uint32_t i = begin; i < end; ++i) {
    const double along = static_cast<double>(dx[i] * nx[i] + dy[i] * ny[i] + dz[i] * nz[i]);
    lane[i % kRingLanes] += along * along;
  }
  return add_lanes(lane);
}

}  // namespace plc::kernels::scalar
