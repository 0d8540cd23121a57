// The surface that a recovery starts from (3.6), on whichever level it starts.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/base/schedule.h"
#include "engine/base/statistics.h"
#include "engine/mesh/mesh.h"
#include "engine/mesh/mesh_space.h"
#include "engine/start/start_hooks.h"
#include "pyramid/pyramid.h"
#include "pyramid/status.h"

namespace plc {

enum class Init {
  kBubble,   // one bubble around the object
  kBubbles,  // a grid of bubbles over the image
  kSeeds,    // spheres
  kIso,      // the iso-surface of the image (figure 23)
  kMask,     // the surface of a mask
  kMesh      // a given mesh
};

struct Seed {
  std::array<double, 3> centre{};  // voxel indices of the unpadded I_0
  std::array<double, 3> radii{};   // voxels
};

struct StartSpec {
  // Whether what it starts from is brought to the sizes of the level (conform.h); but for a patch.
  bool conforms() const { return init == Init::kIso || init == Init::kMask || init == Init::kMesh; }

  Init init = Init::kBubble;
  std::array<int, 3> bubbles{1, 1, 1};
  std::vector<Seed> seeds;
  Pyramid mask;             // kMask: a pyramid like the image's, the object near 1
  Vector<double> xyz;       // kMesh: three voxel indices of the unpadded I_0 per vertex
  Vector<double> as_given;  // ... the same vertices as the user gave them, for messages
  Vector<uint32_t> abc;     // ... three vertices per face, counter-clockwise seen from outside
  bool patch = false;       // ... a part of a larger surface, perhaps without a face
  Vector<uint8_t> held;     // ... of a patch, a value of patch.h per vertex
};

// What the start needs to know of its level.
struct LevelImage {
  const Pyramid& pyramid;
  int h;
  int pad;  // voxels by which I_0 is larger than the input on every side
  MeshSpace space;
  std::optional<float> iso;  // none: nothing tells the object, a bubble goes around the whole image
  bool inside_above;
};

// Clears the mesh and makes it the initial surface for `delta`. It has no vertices where the level
// shows no object (kBubble, kIso, kMask). Errors: kInvalidArgument (bubbles or seeds too small, too
// near each other), kInvalidData (a mesh that is not a closed, oriented, embedded surface, or a
// surface that meets an obstacle of the mesh), kCancelled, with the mesh spoilt, where go_on, asked
// now and then, says so.
Status start_surface(const StartSpec& spec, const LevelImage& level, double delta,
                     const Schedule& schedule, Mesh& mesh, OperationCounts& counts,
                     const StartHooks& hooks);

}  // namespace plc
