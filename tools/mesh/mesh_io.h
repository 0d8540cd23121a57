// Reading and writing of triangle meshes: STL, PLY, OBJ, OFF, VTP, VTK, GIFTI; writing of GLB and
// 3MF. No library reads all of them, tells what is wrong with a damaged file in one line, takes no
// memory that the file has not, and writes the same bytes everywhere. VTK knows most of them, but
// is 135 libraries of 105 MB; tinygltf, gifticlib and lib3mf know one format each and hold the mesh
// once more. What the formats are made of - XML, JSON, zlib, zip - libraries do.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/file/atomic_file.h"

namespace plc::tools {

// One value per vertex; NaN where there is none.
struct Scalars {
  std::string name;  // letters, digits and _
  std::vector<float> values;
  // Of parts, not measures: the name has "label" in it, in whatever case, and all values that there
  // are are integers that a float holds exactly.
  bool are_labels() const;

  static constexpr const char* kLabels = "Label";
};

// What a label is called, and its colour in sRGB.
struct LabelInfo {
  int32_t value = 0;
  std::string name;  // UTF-8 without control characters
  std::array<uint8_t, 3> rgb{};
};

// What coordinates mean, as files name it after "SPACE=": 3D Slicer looks for the first two.
namespace space_names {
inline constexpr const char* kLps = "LPS";      // mm, x to the left, y to the back, z to the head
inline constexpr const char* kRas = "RAS";      // mm, x to the right, y to the front
inline constexpr const char* kVoxel = "voxel";  // indices of an image
}  // namespace space_names

struct TriangleMesh {
  std::vector<double> xyz;     // three per vertex
  std::vector<uint32_t> abc;   // three per face
  std::vector<float> normals;  // three per vertex, or none
  std::vector<Scalars> scalars{};
  // Of its first values, where those are labels: ascending; or none. Not read from files.
  std::vector<LabelInfo> labels{};
  bool doubles = false;  // how the coordinates are written, else as floats
  std::string space{};   // one of space_names; "" where that is not known
};

// By suffix. Polygons are fan-triangulated; the corners of an STL are welded where they coincide
// exactly. Values at vertices are read from .ply, .vtp, .vtk and .gii. Files of GIFTI are in RAS by
// their standard: they are read to LPS, as everything else is by default. Throws Failure.
TriangleMesh read_mesh(const std::string& path);

// Whether the suffix is that of a mesh, not of an image.
bool is_mesh_path(const std::string& path);
// ".stl, .ply ... and .3mf" of the formats that are used so.
enum class MeshUse { kRead, kWritten, kWrittenWithScalars };
std::string mesh_suffixes(MeshUse use);

// Throws Failure unless the suffix is known, its format holds scalars where they are asked for, and
// a file can be made at `path`: before a long run.
void check_mesh_path(const std::string& path, bool with_scalars = false);
bool holds_scalars(const std::string& path);

// By suffix: .stl, .ply and .vtk binary, .obj, .off, .vtp, .gii, .glb, .3mf. Coordinates in doubles
// are read back as they were; an .stl is text then, and .gii and .glb, which have none, are
// refused. Scalars are float properties of a .ply, point data of .vtp and .vtk, further arrays of a
// .gii, and attributes of a .glb, which the first of them colours; a mesh that has some is refused
// in other formats. Names and colours of labels are comments and colours of a .ply, field data and
// colours of a .vtp, the table of a .gii, and nodes of a .glb, one for each label. Written beside
// the target and renamed: nothing half-written is left behind. Throws Failure.
void write_mesh(const std::string& path, const TriangleMesh& mesh);
// One of several files, which are there once those are committed.
void write_mesh(const std::string& path, const TriangleMesh& mesh, AtomicFiles& files);

}  // namespace plc::tools
