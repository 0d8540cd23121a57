// Reading and writing of triangle meshes: STL, PLY, OBJ, OFF, VTP. No library reads all of them,
// tells what is wrong with a damaged file in one line, takes no memory that the file has not, and
// writes the same bytes everywhere.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/file/atomic_file.h"

namespace plc::tools {

// One value per vertex; NaN where there is none.
struct Scalars {
  std::string name;  // letters and digits where it is written; anything where it was read
  std::vector<float> values;
};

struct TriangleMesh {
  std::vector<double> xyz;         // three per vertex
  std::vector<uint32_t> abc;       // three per face
  std::vector<float> normals;      // three per vertex, or none
  std::vector<Scalars> scalars{};  // of a .ply or .vtp
  bool doubles = false;            // how the coordinates are written, else as floats
};

// By suffix. Polygons are fan-triangulated; the corners of an STL are welded where they coincide
// exactly. Scalars are the first kMaxScalars properties of a .ply's vertices that are neither
// coordinates, normals nor colours, or the point data of a .vtp with one number per point. Throws
// Failure.
constexpr size_t kMaxScalars = 16;
TriangleMesh read_mesh(const std::string& path);

// Throws Failure unless the suffix is known, its format holds scalars where they are asked for, and
// a file can be made at `path`: before a long run.
void check_mesh_path(const std::string& path, bool with_scalars = false);

// By suffix: .stl and .ply binary, .obj, .off, .vtp. Coordinates in doubles are read back as they
// were; an .stl is text then. Scalars are float properties of a .ply and point data of a .vtp; a
// mesh that has some is refused in other formats. Written beside the target and renamed: nothing
// half-written is left behind. Throws Failure.
void write_mesh(const std::string& path, const TriangleMesh& mesh);
// One of several files, which are there once those are committed.
void write_mesh(const std::string& path, const TriangleMesh& mesh, AtomicFiles& files);

}  // namespace plc::tools
