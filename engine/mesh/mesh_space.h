// Where the mesh lives, against the image and against millimetres (4.4).
#pragma once
#include <array>

#include "engine/mesh/mesh.h"
#include "kernels/image.h"
#include "kernels/ring.h"
#include "pyramid/pyramid.h"

namespace plc {

// The three methods of 4.4 for anisotropic voxels.
enum class Anisotropy {
  kPhysical = 1,  // the mesh is regular in mm
  kVoxel = 2,     // the mesh is regular in voxels of I_0, and so are the forces
  kMetric = 3     // the mesh is regular in voxels of the image it evolves in, the forces are in mm
};

// Voxel index i of the unpadded I_0 lies at i * step[axis]. On every level the shortest side of a
// voxel of I_h is U_h / U_0 = rho^h mesh units (kPhysical, kMetric), or rho^h voxels of I_0.
struct MeshSpace {
  std::array<double, 3> step{1, 1, 1};  // mesh units per voxel of I_0
  Metric metric;                        // of the forces: their lengths per mesh unit, in U_0
};

// The space of level h. Only that of kMetric depends on the level: there a voxel of I_h is as long
// on every axis, so that lengths in the mesh are those of a metric bound to the image, and the
// constraints and the hash, which measure in them, need not know.
MeshSpace mesh_space(const Pyramid& pyramid, int h, Anisotropy anisotropy);

// delta of level h, in mesh units: U_h / kUnitPerDelta, so that U_h / delta_h is the same on every
// level, within (14). Where the mesh lives in millimetres it would be as small as the shortest side
// of a voxel everywhere, and a long voxel have any number of vertices: there U_h is doubled until a
// voxel has at most kCubesPerVoxel cubes of it.
// edges: how many times as long all of them are as without the user's word.
struct MeshScale {
  Anisotropy anisotropy = Anisotropy::kVoxel;
  double edges = 1;
};
double level_delta(const Pyramid& pyramid, int h, const MeshScale& scale);

// Moves the mesh from one space into another; positions and velocities.
void change_space(Mesh& mesh, const MeshSpace& from, const MeshSpace& to);

// How the image of level h lies in a space. `pad`: by how many voxels I_0 is larger than the input
// on every side.
ImageView image_view(const Pyramid& pyramid, int h, int pad, const MeshSpace& space);

}  // namespace plc
