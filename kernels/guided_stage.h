// A Runge-Kutta stage under the two forces that every run has, curvature (5) and image (7), in one
// pass: the forces stay in registers. On 100,000 vertices a stage waits for memory; passes of their
// own for each force and for the update moved twice the bytes.
#pragma once
#include "kernels/blocks.h"
#include "kernels/image.h"
#include "kernels/integrate.h"
#include "kernels/ring.h"
#include "kernels/simd.h"

// Bits do not depend on `simd`, and are those of curvature_force, iso_force, rk4_stage and move one
// after the other.
namespace plc::kernels {

// Of (5) as a vertex feels it, per alpha_c.
inline constexpr double kBendStiffness = 2.6;
inline constexpr float kMostCompliance = 2;

struct SurfaceForces {
  RingView ring;
  const Float4* laplacian;  // of the stage, from laplacian() over the whole mesh
  float curvature;          // alpha_c
  ImageView image;
  const Float4* position;  // of the stage
  ConstFloat3s normal;     // the step along the normal
  float attraction;        // delta alpha_I
  float iso;
  // An adaptive mesh. alpha_c is divided by the fourth power of sizes above delta, which keeps the
  // length that (5) smooths over; `smoothing`, which comes to it, by their square: it reaches
  // farther where facets are large. The image's value at a vertex is that at x + facets (L . n) n;
  // of one whose size is above delta the mean over the middles of its edges has the part min(size
  // above delta / delta, star) in it, where the vertex has no more than kRingSlots neighbours. What
  // that adds to the value at the start of a step holds for the step: stage 0 writes it, as what is
  // sampled in between is near, and six times as much as the values themselves.
  //
  // Both forces are multiplied by a vertex's compliance, the inverse of their stiffness there, at
  // most kMostCompliance: that of (7), by what the image rises along the normal from `reach` behind
  // to `reach` ahead, and kBendStiffness of (5)'s coefficient. So all vertices approach their
  // places at one rate, where the image is steep as where it is flat; places do not depend on it.
  // Stage 0 writes it, too.
  bool sized = false;
  float smoothing = 0;
  float facets = 0;
  float star = 0;
  float reach = 0;              // in units of the mesh
  float* from_star = nullptr;   // per vertex
  float* compliance = nullptr;  // per vertex
};

// Stages 0..2, and stage 3 where something else comes before the move.
void guided_stage(SimdTarget simd, int stage, const Rk4Coefficients& coefficients,
                  const SurfaceForces& forces, const Rk4Streams& streams, const Blocks& blocks);

// Stage 3 and the move. `streams.rate` is not written; `ends.velocity` may be the velocity at the
// start of the step.
Movement guided_move(SimdTarget simd, const Rk4Coefficients& coefficients,
                     const SurfaceForces& forces, const Rk4Streams& streams, const MoveBound& bound,
                     const MoveStreams& ends, const Blocks& blocks);

// Of forces with `sized`: f += attraction (iso - value) n, (7) alone. sizes: records whose w is the
// size above delta. begin and end are multiples of kRingLanes.
void sized_iso_force(SimdTarget simd, int stage, const SurfaceForces& forces, const Float4* sizes,
                     uint32_t begin, uint32_t end, Float3s force);

}  // namespace plc::kernels
