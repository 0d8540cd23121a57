#include "tools/command/mesh_precision.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include "tools/command/command_check.h"
#include "tools/file/failure.h"
#include "tools/file/path_suffix.h"

namespace plc::tools {

bool round_to_floats(std::vector<double>& xyz) {
  bool finite = true;
  for (double& x : xyz) {
    x = static_cast<float>(x);
    finite = finite && std::isfinite(x);
  }
  return finite;
}

bool settle_precision(plc_context* context, TriangleMesh& mesh) {
  std::vector<float> rounded(mesh.xyz.size());
  if (plc_mesh_round(context, mesh.xyz.data(), static_cast<int64_t>(mesh.xyz.size() / 3),
                     mesh.abc.data(), static_cast<int64_t>(mesh.abc.size() / 3), rounded.data(),
                     nullptr) == PLC_OK) {
    mesh.xyz.assign(rounded.begin(), rounded.end());
    mesh.doubles = false;
    return true;
  }
  std::vector<double> other = mesh.xyz;  // floats and doubles change places
  const bool finite = round_to_floats(mesh.xyz);
  const plc_check floats = finite ? check_of(context, mesh) : plc_check{};
  std::swap(mesh.xyz, other);
  const plc_check doubles = check_of(context, mesh);
  mesh.doubles = !finite || doubles.valid != 0 ||
                 floats.self_intersections > doubles.self_intersections ||
                 floats.degenerate_faces > doubles.degenerate_faces ||
                 floats.duplicate_points > doubles.duplicate_points;
  if (!mesh.doubles) std::swap(mesh.xyz, other);
  return doubles.valid != 0;
}

void settle_surface(plc_context* context, TriangleMesh& mesh, plc_space space,
                    const std::string& path) {
  if (!settle_precision(context, mesh)) fail_precision(space, path);
}

void fail_precision(plc_space space, const std::string& path) {
  if (space == PLC_SPACE_VOXEL) {
    throw Failure{"internal error: the surface for " + path + " is not valid"};
  }
  throw Failure{path +
                ": not written: the voxels are so small beside their distance from the origin that "
                "faces meet in mm, even in double precision; --space voxel holds the surface"};
}

void tell_precision(bool doubles, const std::string& path) {
  if (!doubles) return;
  std::fprintf(stderr,
               "pellicle: %s: written in double precision%s: rounded to floats, faces would meet\n",
               path.c_str(), path_suffix(path) == ".stl" ? ", as text" : "");
}

const char* precision_text(bool doubles) {
  return doubles ? "double" : "float";
}

}  // namespace plc::tools
