#include "tools/volume/mesh_spaces.h"

#include <cmath>
#include <utility>

#include "tools/file/failure.h"
#include "tools/volume/volume_frame.h"

namespace plc::tools {

namespace {

void turn_round(TriangleMesh& mesh) {
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    if (i % 3 != 2) mesh.xyz[i] = -mesh.xyz[i];
  }
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    if (i % 3 != 2) mesh.normals[i] = -mesh.normals[i];
  }
}

// Of a frame that mirrors: faces seen from outside stay counter-clockwise.
void turn_faces(TriangleMesh& mesh) {
  for (size_t i = 0; i + 2 < mesh.abc.size(); i += 3) std::swap(mesh.abc[i + 1], mesh.abc[i + 2]);
}

// Between LPS and voxels. Normals are left out: where voxels are no cubes they would not be the
// ones of the surface, and every program has its own.
void transform(TriangleMesh& mesh, const plc_image& image, bool to_voxels) {
  for (size_t i = 0; i + 2 < mesh.xyz.size(); i += 3) {
    const Place from = {mesh.xyz[i], mesh.xyz[i + 1], mesh.xyz[i + 2]};
    const Place to = to_voxels ? voxel_of(image, from) : lps_of(image, from);
    for (size_t k = 0; k < 3; ++k) mesh.xyz[i + k] = to[k];
  }
  if (mirrors(image)) turn_faces(mesh);
  mesh.normals.clear();
}

}  // namespace

bool mirrors(const plc_image& image) {
  const double* d = image.direction;
  return d[0] * (d[4] * d[8] - d[5] * d[7]) - d[1] * (d[3] * d[8] - d[5] * d[6]) +
             d[2] * (d[3] * d[7] - d[4] * d[6]) <
         0;
}

const char* space_name(plc_space space) {
  switch (space) {
    case PLC_SPACE_LPS:
      return space_names::kLps;
    case PLC_SPACE_RAS:
      return space_names::kRas;
    case PLC_SPACE_VOXEL:
      break;
  }
  return space_names::kVoxel;
}

std::optional<plc_space> space_named(const std::string& name) {
  for (const plc_space space : {PLC_SPACE_LPS, PLC_SPACE_RAS, PLC_SPACE_VOXEL}) {
    if (name == space_name(space)) return space;
  }
  return std::nullopt;
}

void bring_to(TriangleMesh& mesh, plc_space space, plc_space assumed, const plc_image* image,
              const std::string& path) {
  const bool named = !mesh.space.empty();
  if (!named) mesh.space = space_name(assumed);
  const std::string wanted = space_name(space);
  if (mesh.space == wanted) return;
  const bool from_voxels = mesh.space == space_names::kVoxel;
  const bool to_voxels = space == PLC_SPACE_VOXEL;
  if ((from_voxels || to_voxels) && image == nullptr) {
    throw Failure{path + (named ? ": is in " : ": names no space, and is taken to be in ") +
                  mesh.space + ", and between voxels and mm only its image, " +
                  "which is not given, knows the way to " + wanted};
  }
  if (from_voxels) transform(mesh, *image, false);
  if ((mesh.space == space_names::kRas) != (space == PLC_SPACE_RAS)) turn_round(mesh);
  if (to_voxels) transform(mesh, *image, true);
  mesh.space = wanted;
}

}  // namespace plc::tools
