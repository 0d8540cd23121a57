// Newton's law of motion (4) by Runge-Kutta 4: stage update, movement bound, move (3.5, 3.6).
#pragma once
#include <cstdint>

#include "kernels/ring.h"
#include "kernels/simd.h"

// Ranges [begin, end): multiples of kRingLanes. Bits do not depend on `simd`.
namespace plc::kernels {

// The streams of one RK4 step of m x'' + gamma x' = f.
struct Rk4Streams {
  const float *px, *py, *pz;  // position at the start of the step
  const float *vx, *vy, *vz;  // velocity at the start of the step
  const float *fx, *fy, *fz;  // force at the current stage
  float *sx, *sy, *sz;        // velocity of the stage: read by stages 1..3, written by 0..2
  float *dx, *dy, *dz;        // weighted sum of stage velocities; after stage 3 the displacement
  float *ax, *ay, *az;        // weighted sum of accelerations; after stage 3 the new velocity
  Packed* stage;              // position of the next stage, written by stages 0..2, w = 0
};

struct Rk4Coefficients {
  float inverse_mass;  // 1 / m
  float damping;       // gamma
  float time_step;     // dt
};

// Stage 0..3, in this order of operations (each one rounded):
//   w  = stage 0 ? v : s           the velocity of the stage
//   a  = (f - gamma w) * (1/m)
//   stage 0:    d = w;           A = a
//   stage 1, 2: d = d + (w + w); A = A + (a + a)
//   stage 0, 1: stage position = p + (dt/2) w;  s = v + (dt/2) a
//   stage 2:    stage position = p + dt w;      s = v + dt a
//   stage 3:    d = (d + w) * (dt/6);           A = v + (A + a) * (dt/6)
void rk4_stage(SimdTarget simd, int stage, const Rk4Coefficients& coefficients,
               const Rk4Streams& streams, uint32_t begin, uint32_t end);

// The longest squared displacement of the range (0 for none; NaN is passed over).
float max_squared(SimdTarget simd, const float* dx, const float* dy, const float* dz,
                  uint32_t begin, uint32_t end);

// The speed bound of 3.6: |d| > max_length is scaled down to max_length, |velocity| > max_speed
// down to max_speed (up to rounding); shorter ones keep their bits.
void clamp_movement(SimdTarget simd, float max_length, float max_speed, float* dx, float* dy,
                    float* dz, float* vx, float* vy, float* vz, uint32_t begin, uint32_t end);

// p += d, packed = p; path[v] += |d|. Vertices of valence 0 have d = 0 by the kernels before.
void move(SimdTarget simd, const float* dx, const float* dy, const float* dz, float* px, float* py,
          float* pz, Packed* packed, float* path, uint32_t begin, uint32_t end);

// Sum over the range of (d . n)^2 in double, in the order of lane_sum.h: the kinetic energy along
// the normals (5.1) up to m / (2 s (delta dt)^2).
double normal_energy_sum(SimdTarget simd, const float* dx, const float* dy, const float* dz,
                         const float* nx, const float* ny, const float* nz, uint32_t begin,
                         uint32_t end);

}  // namespace plc::kernels
