// RecoverShape and PyramidalRecoverShape (figures 12 and 13): the surface through the pyramid.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "engine/dynamics.h"
#include "engine/initial_surface.h"
#include "engine/mesh.h"
#include "engine/resolution.h"
#include "engine/schedule.h"
#include "engine/statistics.h"
#include "pyramid/pyramid.h"
#include "pyramid/status.h"

namespace plc {

// Mesh space against the input image: voxel index i of the unpadded I_0 lies at i * step[axis].
// Method 2 of 4.4: step = 1 on every axis. Method 1: step = spacing / U_0. In both U_h = rho^h.
struct MeshSpace {
  std::array<double, 3> step{1, 1, 1};
};

enum class Init { kBubble, kBubbles };

struct RecoverySpec {
  Model model;
  std::vector<double> isos;  // pi_I per level, normalised; [0] is that of I_0
  bool inside_above = true;
  int pad_voxels = 0;  // by which the pyramid's I_0 is larger than the input on every side
  MeshSpace space;
  Init init = Init::kBubble;
  std::array<int, 3> bubbles{1, 1, 1};
  double epsilon = 5e-6;
  int max_iterations = 2000;
};

struct LevelRecord {
  int level = 0;
  double delta = 0;
  int64_t iterations = 0, vertices = 0;
  bool converged = false;
  double energy = 0;
  Seconds seconds;
  OperationCounts operations;
};

struct RecoveryProgress {
  int level, levels, iteration;
  int64_t vertices;
  double energy, fraction;
};
// Returns false to cancel.
using RecoveryProgressFn = std::function<bool(const RecoveryProgress&)>;

// How an image of the pyramid lies in mesh space.
ImageView image_view(const Pyramid& pyramid, int level, const RecoverySpec& spec);

// Evolves `mesh` from the coarsest level of the pyramid to I_0; records gets one entry per level,
// coarse to fine. A level that holds no surface has 0 vertices in its record; the next finer one
// then starts anew. The result is closed, oriented and free of self-intersections. Errors:
// kInvalidArgument (bubbles), kInvalidData (no level holds a surface), kCancelled.
Status pyramidal_recover_shape(const Pyramid& pyramid, const RecoverySpec& spec,
                               const Schedule& schedule, SimdTarget simd,
                               const RecoveryProgressFn& progress, Mesh& mesh,
                               std::vector<LevelRecord>& records);

}  // namespace plc
