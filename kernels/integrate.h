// Newton's law of motion (4) by Runge-Kutta 4: stage update, movement bound, move (3.5, 3.6).
#pragma once
#include <cstdint>
#include <limits>

#include "kernels/blocks.h"
#include "kernels/float3s.h"
#include "kernels/ring.h"
#include "kernels/simd.h"

// Bits do not depend on `simd`.
namespace plc::kernels {

// The streams of one RK4 step of m x'' + gamma x' = f.
struct Rk4Streams {
  const Float4* position;  // at the start of the step
  ConstFloat3s velocity;   // at the start of the step
  Float3s speed;           // of the stage: read by stages 1..3, written by 0..2
  Float3s moved;           // weighted sum of stage velocities, written by stages 1..3;
                           // after stage 3 the displacement
  Float3s rate;            // weighted sum of accelerations; after stage 3 the new velocity
  Float4* stage;           // position of the next stage, written by stages 0..2, w = 0
};

struct Rk4Coefficients {
  float inverse_mass;  // 1 / m
  float damping;       // gamma
  float time_step;     // dt
};

// Stage 0..3, in this order of operations (each one rounded):
//   w  = stage 0 ? v : s           the velocity of the stage
//   a  = (f - gamma w) * (1/m)
//   stage 0:    A = a
//   stage 1:    d = v + (w + w);  A = A + (a + a)
//   stage 2:    d = d + (w + w);  A = A + (a + a)
//   stage 0, 1: stage position = p + (dt/2) w;  s = v + (dt/2) a
//   stage 2:    stage position = p + dt w;      s = v + dt a
//   stage 3:    d = (d + w) * (dt/6);           A = v + (A + a) * (dt/6)
void rk4_stage(SimdTarget simd, int stage, const Rk4Coefficients& coefficients,
               const Rk4Streams& streams, const ConstFloat3s& force, const Blocks& blocks);

// The longest squared displacement of the blocks (0 for none; NaN is passed over).
float max_squared(SimdTarget simd, const ConstFloat3s& moved, const Blocks& blocks);

// Of a vertex's turns: the number of them, and for how many the bound is halved.
inline constexpr uint32_t kTurnsMask = 63;
inline constexpr uint32_t kSlowingTurns = 5;

// The speed bound of 3.6, where a step ends, and what is measured of it.
struct MoveStreams {
  const Float4* position;  // before
  Float4* moved_to;        // not `position`
  Float3s velocity;        // written
  ConstFloat3s normal;     // of the energy
  float* path;
  const uint8_t* turns;
};
struct MoveBound {
  float length;  // of the displacement
  float speed;   // of the velocity
  // Up to so many turns of a vertex. Each one more halves them; with kSlowingTurns more they are 0.
  uint32_t free_turns;
  // With more turns `speed` is 0.
  uint32_t swinging_turns;
  // As how long |d . n| counts in the energy, at most.
  float counted = std::numeric_limits<float>::infinity();
};
struct Movement {
  double energy = 0;   // sum of min(|d . n|, counted)^2, in the order of lane_sum.h: the kinetic
                       // energy along the normals (5.1) up to m / (2 s (delta dt)^2)
  float longest2 = 0;  // the greatest |d|^2
};

// From the displacement d and the new velocity after stage 3: both are shortened to the bound (up
// to rounding; what is within it keeps its bits), which is that part of it that 1 + w of the
// position is where that is below 1; moved_to = p + d with the same w, path += |d|. `moved` becomes
// the bounded displacement. Vertices of valence 0 have d = 0 by the kernels before.
Movement move(SimdTarget simd, const MoveBound& bound, const Float3s& moved,
              const ConstFloat3s& new_velocity, const MoveStreams& streams, const Blocks& blocks);

}  // namespace plc::kernels
