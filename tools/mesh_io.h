// Reading and writing of triangle meshes: STL, PLY, OBJ, OFF, VTP.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/volume_io.h"

namespace plc::tools {

struct TriangleMesh {
  std::vector<double> xyz;     // three per vertex
  std::vector<uint32_t> abc;   // three per face
  std::vector<float> normals;  // three per vertex, or none
};

// By suffix. Polygons are fan-triangulated; the corners of an STL are welded where they coincide
// exactly. Throws Failure.
TriangleMesh read_mesh(const std::string& path);

// Throws Failure unless the suffix is known and a file can be made at `path`: before a long run.
void check_mesh_path(const std::string& path);

// By suffix: .stl and .ply binary (float), .obj, .off, .vtp. Written beside the target and renamed:
// nothing half-written is left behind. Throws Failure.
void write_mesh(const std::string& path, const TriangleMesh& mesh);

}  // namespace plc::tools
