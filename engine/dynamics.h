// Forces, Newton's law of motion by Runge-Kutta 4, movement bound and energy (3.5-3.8, 5.1).
#pragma once
#include <vector>

#include "engine/guide.h"
#include "engine/mesh.h"
#include "engine/schedule.h"
#include "engine/sleep.h"
#include "engine/statistics.h"
#include "kernels/integrate.h"
#include "kernels/simd.h"

namespace plc {

enum class RestLength { kZero, kMean, kValue };
enum class Bound { kClamp, kScale };

// The model's coefficients, validated; see plc_parameters for units and ranges.
struct Model {
  float curvature = 0.4F;  // alpha_c
  float spring = 0;        // alpha_e
  RestLength rest_length = RestLength::kMean;
  float rest_length_value = 0;  // in delta
  float attraction = -1;        // alpha_I, negative when the object is bright; 0: no iso force
  float gradient_normal = 0;    // alpha_gradI (8)
  float gradient_tangent = 0;   // beta_gradI (8)
  float mass = 1;
  float damping = 0.5F;
  float time_step = 1;
  float max_move = 0.4F;  // in delta
  Bound bound = Bound::kClamp;
};

// The largest time step, at most the model's, that RK4 takes stably (constants.h), with
// `stiffness` added to that of the model's forces.
float stable_time_step(const Model& model, float stiffness = 0);

// The movement part of one iteration. Owns the streams that live within a step:
//
//   stream     bytes  written by
//   force      12     forces, per stage
//   speed      12     rk4: velocity of the stage
//   rate       12     rk4: sum of accelerations, after stage 3 the new velocity
//   stage      2x16   rk4: position of the stage, read and written in turn
//   laplacian  16     laplacian, per stage
//   along      24     normals: unit normals of the metric and their steps; only with a metric
//   user       12     user force, per stage; only where there is one
//   before     16     move: where the vertex was, for taking the movement back
class Dynamics {
 public:
  Dynamics(Mesh& mesh, const Schedule& schedule, SimdTarget simd, const Model& model);

  // Moves every vertex once; displacement, velocity, normal and path of the mesh are written. Fails
  // where the user's force does; the surface is then where it was, or somewhere on the way.
  Status step(const Guide& guide, Seconds& seconds, const Sleep* sleep = nullptr);
  // Mean of m (dx . n / (delta dt))^2 / 2 over the vertices, of the last step.
  double energy() const { return energy_; }
  // The longest movement of the last step, in delta per time.
  double speed() const { return speed_of_fastest_; }
  // Positions before the last step.
  const Buffer<Packed>& before() const { return before_; }

 private:
  std::vector<uint32_t> awake_;
  void resize();
  std::vector<Pass> passes(const Guide& guide, Seconds& seconds);
  void add_stage(int stage, const Guide& guide, Seconds& seconds, std::vector<Pass>& table);
  void stage_forces(int stage, const Guide& guide, uint32_t begin, uint32_t end);
  void normals(const Guide& guide);
  void image_forces(int stage, const Guide& guide, uint32_t begin, uint32_t end);
  void laplacians(int stage);
  void user_force(int stage, const Guide& guide);
  void forces_and_stage(int stage, const Guide& guide);
  float fastest() const;
  void scale_time_step(const Guide& guide, float longest);
  void measure_rest_length(const Guide& guide);
  void bound(const Guide& guide);
  void hold_pinned(const Guide& guide);
  void move();
  void measure_energy();
  kernels::Rk4Streams streams(int stage);
  const Packed* stage_position(int stage) const;
  // body(begin, end) over blocks of kGrain.
  void blocks(const std::function<void(uint32_t, uint32_t)>& body) const;
  // Sum of body(begin, end) over blocks, in block order.
  double block_sum(const std::function<double(uint32_t, uint32_t)>& body) const;

  Mesh& mesh_;
  const Schedule& schedule_;
  SimdTarget simd_;
  Model model_;
  float time_step_;  // of this step
  float rest_length_ = 0;
  double energy_ = 0;
  double speed_of_fastest_ = 0;
  Status status_;
  Streams3 force_, speed_, rate_;
  Streams3 metric_normal_, metric_step_;
  Streams3 user_force_;
  Buffer<Packed> stage_[2];
  Buffer<Packed> laplacian_;
  Buffer<Packed> before_;
};

}  // namespace plc
