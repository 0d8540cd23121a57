// What read_mesh() and write_mesh() dispatch to. Readers get the whole file and throw Failure.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "tools/file/atomic_file.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

TriangleMesh read_obj(const std::string& path, std::string_view data);
TriangleMesh read_off(const std::string& path, std::string_view data);
TriangleMesh read_ply(const std::string& path, std::string_view data);
TriangleMesh read_stl(const std::string& path, std::string_view data);
TriangleMesh read_vtp(const std::string& path, std::string_view data);

void write_obj(AtomicFile& file, const TriangleMesh& mesh);
void write_off(AtomicFile& file, const TriangleMesh& mesh);
void write_ply(AtomicFile& file, const TriangleMesh& mesh);
void write_stl(AtomicFile& file, const TriangleMesh& mesh);
void write_vtp(AtomicFile& file, const TriangleMesh& mesh);

// Collects what a reader finds.
class MeshBuilder {
 public:
  explicit MeshBuilder(std::string path) : path_(std::move(path)) {}

  size_t vertex_count() const { return mesh_.xyz.size() / 3; }
  void vertex(double x, double y, double z) { mesh_.xyz.insert(mesh_.xyz.end(), {x, y, z}); }
  void normal(double x, double y, double z);
  // A value of the last vertex. Where a vertex has got none, it is NaN; beyond kMaxScalars names
  // they are left out.
  void scalar(const std::string& name, double value);
  // A fan around the first corner. Failure below 3 corners or where an index is no uint32.
  void polygon(std::span<const int64_t> corners);
  void triangle(int64_t a, int64_t b, int64_t c);
  // Checks every index; keeps the normals where there is one per vertex, and all scalars.
  TriangleMesh finish();

 private:
  uint32_t index(int64_t corner) const;
  std::string path_;
  TriangleMesh mesh_;
};

}  // namespace plc::tools
