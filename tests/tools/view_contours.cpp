// Prints where a mesh meets a slice of an image, for the test of `pellicle view`: the total length,
// then the ends of each segment in LPS (mm).   view_contours IMAGE MESH lps|ras|voxel AXIS SLICE
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/tools/plane_contours.h"
#include "tools/file/failure.h"
#include "tools/volume/mesh_spaces.h"
#include "tools/volume/volume_io.h"

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  try {
    const plc::tools::LoadedVolume volume = plc::tools::read_volume(argv[1]);
    plc::tools::TriangleMesh mesh = plc::tools::read_mesh(argv[2]);
    const std::string space = argv[3];
    const plc_space assumed = space == "voxel" ? PLC_SPACE_VOXEL
                              : space == "ras" ? PLC_SPACE_RAS
                                               : PLC_SPACE_LPS;
    plc::tools::bring_to(mesh, PLC_SPACE_LPS, assumed, &volume.image, argv[2]);
    const auto axis = static_cast<size_t>(std::atoi(argv[4]));
    const auto segments = samples::plane_contours(mesh, volume.image, axis, std::atof(argv[5]));
    std::printf("%.17g\n", samples::length_of(segments));
    for (const auto& [a, b] : segments) {
      std::printf("%.17g %.17g %.17g %.17g %.17g %.17g\n", a[0], a[1], a[2], b[0], b[1], b[2]);
    }
  } catch (const plc::tools::Failure& failure) {
    std::fprintf(stderr, "%s\n", failure.message.c_str());
    return 2;
  }
  return 0;
}
