#include "tools/mesh/mesh_io.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"
#include "tools/file/memory.h"
#include "tools/file/path_suffix.h"
#include "tools/mesh/mesh_io_formats.h"

namespace plc::tools {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

struct Format {
  const char* suffix;
  TriangleMesh (*read)(const std::string& path, std::string_view data);
  void (*write)(AtomicFile& file, const TriangleMesh& mesh);
  bool has_scalars;
};

const Format& format_of(const std::string& path) {
  static constexpr Format kFormats[] = {{".stl", read_stl, write_stl, false},
                                        {".ply", read_ply, write_ply, true},
                                        {".obj", read_obj, write_obj, false},
                                        {".off", read_off, write_off, false},
                                        {".vtp", read_vtp, write_vtp, true}};
  const std::string suffix = path_suffix(path);
  for (const Format& format : kFormats) {
    if (suffix == format.suffix) return format;
  }
  throw Failure{path + ": unknown format of meshes (known are .stl, .ply, .obj, .off and .vtp)"};
}

const Format& format_for(const std::string& path, bool with_scalars) {
  const Format& format = format_of(path);
  if (with_scalars && !format.has_scalars) {
    throw Failure{path + ": this format has no values at vertices (.ply and .vtp have)"};
  }
  return format;
}

std::string contents(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw Failure{path + ": there is no such file"};
  if (!std::filesystem::is_regular_file(status)) throw Failure{path + ": is not a file"};
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw Failure{path + ": cannot be read: " + error.message()};
  // The text and the mesh made of it, which no format stores in less than half its size.
  require_memory(path, times(size, 3));
  std::ifstream file(path, std::ios::binary);
  std::string data(size, '\0');
  if (!file.read(data.data(), static_cast<std::streamsize>(size))) {
    throw Failure{path + ": cannot be read"};
  }
  return data;
}

}  // namespace

void MeshBuilder::normal(double x, double y, double z) {
  mesh_.normals.insert(mesh_.normals.end(),
                       {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)});
}

void MeshBuilder::scalar(const std::string& name, double value) {
  auto& all = mesh_.scalars;
  auto found =
      std::find_if(all.begin(), all.end(), [&](const Scalars& s) { return s.name == name; });
  if (found == all.end()) {
    if (all.size() == kMaxScalars) return;
    found = all.insert(all.end(), Scalars{name, {}});
  }
  if (found->values.size() < vertex_count()) found->values.resize(vertex_count(), kNone);
  if (!found->values.empty()) found->values.back() = static_cast<float>(value);
}

uint32_t MeshBuilder::index(int64_t corner) const {
  if (!std::in_range<uint32_t>(corner)) {
    throw Failure{path_ + ": face " + std::to_string(mesh_.abc.size() / 3) + " refers to vertex " +
                  std::to_string(corner)};
  }
  return static_cast<uint32_t>(corner);
}

void MeshBuilder::triangle(int64_t a, int64_t b, int64_t c) {
  mesh_.abc.insert(mesh_.abc.end(), {index(a), index(b), index(c)});
}

void MeshBuilder::polygon(std::span<const int64_t> corners) {
  if (corners.size() < 3) {
    throw Failure{path_ + ": has a face of " + std::to_string(corners.size()) + " corners"};
  }
  for (size_t i = 2; i < corners.size(); ++i) triangle(corners[0], corners[i - 1], corners[i]);
}

TriangleMesh MeshBuilder::finish() {
  const size_t count = vertex_count();
  if (count > std::numeric_limits<uint32_t>::max()) {
    throw Failure{path_ + ": has too many vertices (" + std::to_string(count) + ")"};
  }
  for (size_t i = 0; i < mesh_.abc.size(); ++i) {
    if (mesh_.abc[i] < count) continue;
    throw Failure{path_ + ": face " + std::to_string(i / 3) + " refers to vertex " +
                  std::to_string(mesh_.abc[i]) + " of " + std::to_string(count)};
  }
  if (mesh_.normals.size() != mesh_.xyz.size()) mesh_.normals.clear();
  for (Scalars& scalars : mesh_.scalars) scalars.values.resize(count, kNone);
  return std::move(mesh_);
}

TriangleMesh read_mesh(const std::string& path) {
  const Format& format = format_of(path);
  const std::string data = contents(path);
  if (data.empty()) throw Failure{path + ": is empty"};
  try {
    return format.read(path, data);
  } catch (const std::bad_alloc&) {
    throw Failure{path + ": not enough memory to read it"};
  } catch (const std::length_error&) {  // of a string or vector longer than any memory
    throw Failure{path + ": not enough memory to read it"};
  }
}

void check_mesh_path(const std::string& path, bool with_scalars) {
  format_for(path, with_scalars);
  const AtomicFile file(path);
}

void write_mesh(const std::string& path, const TriangleMesh& mesh) {
  AtomicFiles files;
  write_mesh(path, mesh, files);
  files.commit();
}

void write_mesh(const std::string& path, const TriangleMesh& mesh, AtomicFiles& files) {
  const Format& format = format_for(path, !mesh.scalars.empty());
  format.write(files.add(path), mesh);
}

}  // namespace plc::tools
