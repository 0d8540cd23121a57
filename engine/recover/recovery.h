// RecoverShape and PyramidalRecoverShape (figures 12 and 13): the surface through the pyramid.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "engine/base/constants.h"
#include "engine/base/defaults.h"
#include "engine/base/schedule.h"
#include "engine/base/state_io.h"
#include "engine/base/statistics.h"
#include "engine/guard/obstacles.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/mesh_space.h"
#include "engine/motion/dynamics.h"
#include "engine/recover/evolution.h"
#include "engine/recover/pass_observer.h"
#include "engine/recover/progress_estimate.h"
#include "engine/resolve/resolution.h"
#include "engine/start/late_bubbles.h"
#include "engine/start/level_start.h"
#include "engine/start/voxel_set.h"
#include "pyramid/pyramid.h"
#include "pyramid/status.h"

namespace plc {

// As UserForce, on a level and in its space.
using LevelForce = std::function<Status(int level, const MeshSpace& space, const Mesh& mesh,
                                        const Float4* position, Streams3& force)>;

struct RecoverySpec {
  Model model;
  // An adaptive mesh: lengths in delta of each level. None: the paper's, uniform.
  std::optional<SizeSpec> sizes;
  std::vector<double> isos;  // pi_I per level, normalised; [0] is that of I_0; empty: no iso force
  bool inside_above = true;
  // Of (8): the largest norm, in window per U_h; used norms are <= 1.
  double gradient_bound = defaults::kGradientBound;
  int pad_voxels = kPadVoxels;  // by which the pyramid's I_0 is larger than the input on every side
  MeshScale scale;
  StartSpec start;
  // Attachments and pins, their places in voxel indices of the unpadded I_0; the force is not read.
  UserConstraints user;
  // What the surface may not meet on I_0, the only level then (guard/obstacles.h): three voxel
  // indices of the unpadded I_0 per vertex, three vertices per face; no late bubbles are started.
  Vector<double> obstacle_xyz;
  Vector<uint32_t> obstacle_abc;
  double obstacle_gap = 0;  // delta
  // Of a patch (StartSpec::held): the box in which its vertices may move, voxel indices of the
  // unpadded I_0; whether it lies inside where it has no face. A patch is of one level.
  std::array<double, 3> room_low{}, room_high{};
  bool room_inside = false;
  LevelForce force;  // may be empty
  bool late_bubbles = true;
  bool sleeping = true;       // sleep.h; never with a user's force, which may change at any time
  bool slow_vertices = true;  // 3.6; false: every vertex is checked in every iteration
  bool renumbering = true;    // along a space-filling curve, at refinements and as ids scatter
  double epsilon = defaults::kEpsilon;
  double calm_speed = defaults::kCalmSpeed;  // delta per time; 0: the energy alone tells
  int max_iterations = defaults::kMaxIterations;
};

struct LevelRecord {
  int level = 0;
  double delta = 0;
  int64_t iterations = 0, vertices = 0;
  bool converged = false;
  double energy = 0, speed = 0;  // of the last iteration; speed of the fastest, delta per time
  Seconds seconds;
  OperationCounts operations;
  LateBubbles late;                               // volume in mm3
  int64_t frozen_sites = 0, frozen_vertices = 0;  // at the end (frozen_sites.h)
};

// What the user says of a level that has come to its end.
enum class LevelVerdict { kAccept, kMore, kStop, kCancel };

struct RecoveryProgress {
  int level, levels, iteration;
  int64_t vertices;
  double energy, speed, fraction;
};

struct RecoveryHooks {
  // After every iteration; returns false to stop there. May be empty.
  std::function<bool(const RecoveryProgress&)> progress;
  // At the end of every level that holds a surface, which is then in mesh_space() of that level,
  // without gaps in the ids. kMore: up to max_iterations more. kStop: the recovery ends here.
  // kCancel: it stops there, and asks again when it goes on. May be empty.
  std::function<LevelVerdict(const LevelRecord&)> level;
  // When a level has been left, whether it holds a surface or not. May be empty.
  std::function<void(const LevelRecord&)> left{};
  // After every pass. For tests; may be empty.
  PassObserver pass{};
};

// How far a recovery goes on in one call.
enum class Amount { kIteration, kLevel, kAll };

// The surface's way through the pyramid, which may be left and saved between any two iterations.
class Recovery {
 public:
  // Evolves `mesh`, which is empty, from the coarsest level of the pyramid to I_0; records gets
  // one entry per level, coarse to fine. Both must outlive it, as must the schedule. The pyramid is
  // given away: a level's values are released when the recovery goes on to the next finer one, so
  // that on I_0, which is borrowed, none are left.
  Recovery(Pyramid pyramid, RecoverySpec spec, const Schedule& schedule, RecoveryHooks hooks,
           Mesh& mesh, std::vector<LevelRecord>& records);

  // Makes the initial surface on the coarsest level that shows the object. A level that holds no
  // surface has 0 vertices in its record; the next finer one then starts anew. Errors: those of
  // start_surface(), kInvalidData (no level holds a surface), kOutOfMemory.
  Status start();
  // Goes on, after start(). The mesh is in space() and, where the level has come to its end or all
  // is done, without gaps in its ids; closed, oriented, free of self-intersections. kCancelled, by
  // the progress hook or the user's force: it can go on. After any other error it can not:
  // kInvalidData (no level holds a surface), kOutOfMemory, what the user's force returns.
  Status advance(Amount amount);
  bool done() const { return done_; }
  // The last level has come to its end.
  bool between_levels() const { return done_ || phase_ == Phase::kStart; }
  const MeshSpace& space() const { return space_; }
  // Of the last iteration.
  const RecoveryProgress& progress() const { return progress_; }

  // save() writes the state between two calls: mesh and records, but not the pyramid, the spec and
  // the hooks. restore() is called instead of start() on a recovery with an equal pyramid and spec,
  // which then goes on with the same bits. Errors, after which it cannot be used: kInvalidData,
  // what it reads is no such state; kOutOfMemory.
  void save(StateWriter& to) const;
  Status restore(StateReader& from);

 private:
  enum class Phase : uint8_t { kStart, kIterate, kSearch, kCheck, kVerify, kRoundEnd, kVerdict };
  // Vertices that sleep do not move, whether they are at rest or not. So all are woken before a
  // level ends, and it has converged when they stay calm. An adaptive mesh is searched for what it
  // has missed before that: what gets late bubbles goes on anyway. And in its first round already
  // when it is near rest, so that what it gets comes to rest along with the others.
  struct Confirmation {
    int since = 0;       // iteration in which all were woken; 0: they were not
    int not_before = 0;  // iteration in which they may be woken again
  };
  // A level's iterations until it converges or max_iterations are used up; the rounds after late
  // bubbles share theirs.
  struct Round {
    int number = 0;
    bool late = false;
    bool searched_early = false, searched = false;  // for missed places, before it was confirmed
    bool settled = false;                           // it began with all asleep but what was new
    int iteration = 0;
    int calm = 0;  // iterations in a row
    Confirmation confirmation;
    int64_t most_vertices = 0;  // no surface of the level's image has more
    int repairs = 0;
  };

  Status step();
  Status start_level();
  void enter(int h);
  void place_obstacles();
  void place_room();
  VoxelRoom voxel_room() const;
  Status build_gradient_image();
  Status build_sizing();
  void lower_sizes();
  void resize_all();
  Status adapt(bool conformed);
  void start_round(int number, bool late);
  int iterations_left() const;  // of the round
  int iterations_across() const;
  Status iterate();
  void count_frozen();
  void check();
  void delete_crumbs();
  Status verify();
  bool searched_again() const;
  bool is_due_early() const;
  bool near_rest() const;
  Status search(bool& added);
  Status end_round();
  Status ask_verdict();
  Status leave_level();
  Status add_late_bubbles(bool& added);
  Status report_progress() const;  // of the last iteration, to the user
  bool confirmed(int calm);
  bool read(StateReader& from);
  bool read_set(StateReader& from, VoxelSet& voxels) const;
  void renumber();
  void renumber_if_scattered();
  void estimate_progress();
  double delta_of(int h) const { return level_delta(pyramid_, h, spec_.scale); }
  Status check_growth() const;
  double unit_of(int h) const;
  std::optional<float> iso_of(int h) const {
    if (spec_.isos.empty()) return std::nullopt;
    return static_cast<float>(spec_.isos[static_cast<size_t>(h)]);
  }
  const PyramidLevel& image_of(int h) const { return pyramid_.levels[static_cast<size_t>(h)]; }
  LevelRecord& record() { return records_.back(); }

  Pyramid pyramid_;
  RecoverySpec spec_;
  const Schedule& schedule_;
  RecoveryHooks hooks_;
  Mesh& mesh_;
  std::vector<LevelRecord>& records_;
  int levels_;
  Evolution evolution_;
  int level_;         // h
  int entered_ = -1;  // the level of space_ and guide_; -1: none yet
  Phase phase_ = Phase::kStart;
  bool done_ = false;
  Round round_;
  int late_iterations_ = 0;  // of the level's rounds after late bubbles
  MeshSpace space_;
  Sizing sizing_;  // of the level, where the mesh is adaptive
  Guide guide_;
  UserConstraints user_;  // in the space of the level
  std::optional<Obstacles> obstacles_;
  Buffer<Float4> gradient_;  // of the level
  VoxelSet tried_;           // voxels of the level's late bubbles
  VoxelSet folds_;           // ... of its folds (folds.h)
  double energy_ = 0;        // of the last iteration on any level
  RecoveryProgress progress_{};
  ProgressEstimate estimate_;
};

// A whole recovery: start, and advance to the end.
Status pyramidal_recover_shape(Pyramid pyramid, const RecoverySpec& spec, const Schedule& schedule,
                               const RecoveryHooks& hooks, Mesh& mesh,
                               std::vector<LevelRecord>& records);

}  // namespace plc
