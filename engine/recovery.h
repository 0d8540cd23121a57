// RecoverShape and PyramidalRecoverShape (figures 12 and 13): the surface through the pyramid.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "engine/dynamics.h"
#include "engine/late_bubbles.h"
#include "engine/level_start.h"
#include "engine/mesh.h"
#include "engine/mesh_space.h"
#include "engine/pass_observer.h"
#include "engine/resolution.h"
#include "engine/schedule.h"
#include "engine/statistics.h"
#include "pyramid/pyramid.h"
#include "pyramid/status.h"

namespace plc {

// As UserForce, on a level and in its space.
using LevelForce = std::function<Status(int level, const MeshSpace& space, const Mesh& mesh,
                                        const Packed* position, Streams3& force)>;

struct RecoverySpec {
  Model model;
  std::vector<double> isos;  // pi_I per level, normalised; [0] is that of I_0; NAN: no iso force
  bool inside_above = true;
  double gradient_bound = 0.1;  // of (8): the largest norm, in window per U_h; used norms are <= 1
  int pad_voxels = 0;           // by which the pyramid's I_0 is larger than the input on every side
  Anisotropy anisotropy = Anisotropy::kVoxel;
  StartSpec start;
  // Attachments and pins, their places in voxel indices of the unpadded I_0; the force is not read.
  UserConstraints user;
  LevelForce force;  // may be empty
  bool late_bubbles = true;
  bool sleeping = true;       // sleep.h; never with a user's force, which may change at any time
  bool slow_vertices = true;  // 3.6; false: every vertex is checked in every iteration
  bool renumbering = true;    // along a space-filling curve, at refinements and as ids scatter
  double epsilon = 5e-6;
  double calm_speed = 0;  // delta per time; 0: the energy alone tells
  int max_iterations = 2000;
};

struct LevelRecord {
  int level = 0;
  double delta = 0;
  int64_t iterations = 0, vertices = 0;
  bool converged = false;
  double energy = 0, speed = 0;  // of the last iteration; speed of the fastest, delta per time
  Seconds seconds;
  OperationCounts operations;
  LateBubbles late;  // volume in mm3
};

// What the user says of a level that has come to its end.
enum class LevelVerdict { kAccept, kMore, kStop };

struct RecoveryProgress {
  int level, levels, iteration;
  int64_t vertices;
  double energy, speed, fraction;
};

struct RecoveryHooks {
  // After every iteration; returns false to cancel. May be empty.
  std::function<bool(const RecoveryProgress&)> progress;
  // At the end of every level that holds a surface, which is then in mesh_space() of that level,
  // without gaps in the ids. kMore: up to max_iterations more. kStop: the recovery ends here. May
  // be empty.
  std::function<LevelVerdict(const LevelRecord&)> level;
  // After every pass. For tests; may be empty.
  PassObserver pass{};
};

// Evolves `mesh` from the coarsest level of the pyramid to I_0; records gets one entry per level,
// coarse to fine. A level that holds no surface has 0 vertices in its record; the next finer one
// then starts anew. The result is closed, oriented, free of self-intersections and in mesh_space()
// of the last level of the records. Errors: those of start_surface(), kInvalidData (no level holds
// a surface), kCancelled, kOutOfMemory, what the user's force returns.
//
// The pyramid is given away: a level's values are released when the recovery goes on to the next
// finer one, so that on I_0, which is borrowed, none are left.
Status pyramidal_recover_shape(Pyramid pyramid, const RecoverySpec& spec, const Schedule& schedule,
                               SimdTarget simd, const RecoveryHooks& hooks, Mesh& mesh,
                               std::vector<LevelRecord>& records);

}  // namespace plc
