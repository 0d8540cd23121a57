// Forces, Newton's law of motion by Runge-Kutta 4, movement bound and energy (3.5-3.8, 5.1).
#pragma once
#include <limits>
#include <vector>

#include "engine/base/defaults.h"
#include "engine/base/schedule.h"
#include "engine/base/state_io.h"
#include "engine/base/statistics.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/state_hash.h"
#include "engine/motion/guide.h"
#include "engine/motion/sleep.h"
#include "kernels/blocks.h"
#include "kernels/guided_stage.h"
#include "kernels/integrate.h"
#include "pyramid/memory.h"

namespace plc {

enum class RestLength { kZero, kMean, kValue };
enum class Bound { kClamp, kScale };

// The model's coefficients, validated; see plc_parameters for units and ranges.
struct Model {
  float curvature = static_cast<float>(defaults::kCurvature);  // alpha_c
  float spring = static_cast<float>(defaults::kSpring);        // alpha_e
  RestLength rest_length = RestLength::kMean;
  float rest_length_value = static_cast<float>(defaults::kRestLength);  // in delta
  // alpha_I, negative when the object is bright; 0: no iso force
  float attraction = static_cast<float>(-defaults::kAttraction);
  float gradient_normal = 0;   // alpha_gradI (8)
  float gradient_tangent = 0;  // beta_gradI (8)
  float mass = static_cast<float>(defaults::kMass);
  float damping = static_cast<float>(defaults::kDamping);
  float time_step = static_cast<float>(defaults::kTimeStep);
  float max_move = static_cast<float>(defaults::kMaxMove);  // in delta
  Bound bound = Bound::kClamp;
};

// The largest time step, at most the model's, that RK4 takes stably (constants.h), with
// `stiffness` added to that of the model's forces.
float stable_time_step(const Model& model, float stiffness = 0);

// What a model is like where its forces are multiplied by compliances (kernels/guided_stage.h): (5)
// and (7) are together of the stiffness 1, others grow by the most.
Model complying(Model model);

// The movement part of one iteration. Owns the streams that live within a step:
//
//   stream     bytes  written by
//   speed      12     stages: velocity of the stage
//   rate       12     stages: sum of accelerations; the new velocity where a pass lies between the
//                     last stage and the move
//   stage      2x16   stages: position of the stage, read and written in turn; then one is the
//                     mesh's positions, by swapping, and the other where the vertices were
//   laplacian  16     laplacian, per stage
//   force      12     forces, per stage; only with other forces than curvature and image
//   along      24     normals: unit normals of the metric and their steps; only with a metric
//   user       12     user force, per stage; only where there is one
//   from star  4      the first stage, of an adaptive mesh (guided_stage.h)
//   compliance 4      the first stage, of an adaptive mesh
//
// 72 bytes per vertex in a run of curvature and image, and 4 per block of 16.
class Dynamics {
 public:
  // counted: how far along its normal, in delta, a vertex counts as moved in the energy, at most.
  Dynamics(Mesh& mesh, const Schedule& schedule, const Model& model,
           float counted = std::numeric_limits<float>::infinity());

  // Moves every vertex once; displacement, velocity, normal and path of the mesh are written. Fails
  // where the user's force does; positions, velocities and paths are then as they were.
  Status step(const Guide& guide, Seconds& seconds);
  // The passes of a step, in which those that sleep do not take part; sleep may be null. What they
  // are made of outlives them.
  void append_passes(const Guide& guide, const Sleep* sleep, Seconds& seconds,
                     std::vector<Pass>& table);
  // Whether passes are to run in order, on the calling thread: so the user's force is called.
  bool in_order(const Guide& guide) const;
  // Mean of m (dx . n / (delta dt))^2 / 2 over the vertices, of the last step.
  double energy() const { return energy_; }
  // The longest movement of the last step, in delta per time.
  double speed() const { return speed_of_fastest_; }
  // Positions before the last step.
  const Buffer<Float4>& before() const { return stage_[0]; }
  // What the next step reads beside the mesh: the Laplacians of blocks that sleep, of when they
  // fell asleep; and energy and speed.
  void save(StateWriter& to) const;
  void restore(StateReader& from);
  // What it holds beside the mesh.
  void append_hashes(std::vector<PartHash>& hashes) const;

 private:
  void begin_step(const Guide& guide, const Sleep* sleep);
  void resize(const Guide& guide);
  void choose_blocks(const Sleep* sleep);
  void add_stage(int stage, const Guide& guide, Seconds& seconds, std::vector<Pass>& table);
  void normals(const Guide& guide);
  void laplacians(int stage);
  Status user_force(int stage, const Guide& guide);
  void measure_rest_length(const Guide& guide);
  // A stage: the forces, and the update under them.
  void run_stage(int stage, const Guide& guide);
  void gather_forces(int stage, const Guide& guide, uint32_t begin, uint32_t end);
  float curvature() const;
  float smoothing() const;
  void scale_by_size(uint32_t begin, uint32_t end);
  void image_forces(int stage, const Guide& guide, uint32_t begin, uint32_t end);
  // From the last stage to the end of the step: where nothing lies between them in one pass.
  void last_stage_and_move(const Guide& guide);
  Status scale_time_step(const Guide& guide);
  template <typename Hold>
  void hold_where(const Hold& hold);
  void hold_pinned(const Guide& guide);
  void hold_patch(const Guide& guide);
  void move();
  void end_step();
  float longest_move() const;

  // Whether curvature and image are the only forces, and whether nothing happens between the last
  // stage and the move.
  bool only_surface_forces(const Guide& guide) const;
  bool moves_at_once(const Guide& guide) const;
  kernels::Rk4Coefficients coefficients() const;
  kernels::Rk4Streams streams(int stage);
  kernels::SurfaceForces surface_forces(int stage, const Guide& guide);
  kernels::MoveStreams move_streams();
  kernels::MoveBound move_bound() const;
  const Streams3& image_normal(const Guide& guide) const;
  const Float4* stage_position(int stage) const;

  // The blocks that take part in this step, in tasks of kGrain vertices; every pass goes over them.
  size_t tasks() const;
  Blocks task(size_t index) const;
  // body(index of the task, its blocks) for every task.
  void for_tasks(const std::function<void(size_t, const Blocks&)>& body) const;
  // body(begin, end) for every run of blocks in every task.
  void for_runs(const std::function<void(uint32_t, uint32_t)>& body) const;

  Mesh& mesh_;
  const Schedule& schedule_;
  Model model_;
  float counted_;
  // Of this step. Forces are multiplied by compliances in an adaptive mesh without attachments:
  // those add damping (user_constraints.h) that is critical for forces as they are.
  bool complies_ = false;
  float damping_, time_step_;
  float rest_length_ = 0;
  double energy_ = 0;
  double speed_of_fastest_ = 0;
  Vector<uint32_t> blocks_;             // ascending
  Vector<kernels::Movement> movement_;  // by task
  Streams3 force_, speed_, rate_;
  Streams3 metric_normal_, metric_step_;
  Streams3 user_force_;
  Buffer<Float4> stage_[2];
  Buffer<Float4> laplacian_;
  Buffer<float> from_star_, compliance_;
};

}  // namespace plc
