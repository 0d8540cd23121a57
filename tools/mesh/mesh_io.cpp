#include "tools/mesh/mesh_io.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
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

struct Format {
  const char* suffix;
  TriangleMesh (*read)(const std::string& path, std::string_view data);  // null: it is not read
  void (*write)(AtomicFile& file, const TriangleMesh& mesh);
  bool has_scalars;
  bool has_doubles;
};

constexpr std::array<Format, 9> kFormats = {{{".stl", read_stl, write_stl, false, true},
                                             {".ply", read_ply, write_ply, true, true},
                                             {".obj", read_obj, write_obj, false, true},
                                             {".off", read_off, write_off, false, true},
                                             {".vtp", read_vtp, write_vtp, true, true},
                                             {".vtk", read_vtk, write_vtk, true, true},
                                             {".gii", read_gifti, write_gifti, true, false},
                                             {".glb", nullptr, write_glb, true, false},
                                             {".3mf", nullptr, write_3mf, false, true}}};

// Null where there is none of that suffix.
const Format* find_format(const std::string& path) {
  const std::string suffix = path_suffix(path);
  const auto* const found = std::find_if(kFormats.begin(), kFormats.end(),
                                         [&](const Format& f) { return suffix == f.suffix; });
  return found == kFormats.end() ? nullptr : found;
}

bool allows(const Format& format, MeshUse use) {
  switch (use) {
    case MeshUse::kRead:
      return format.read != nullptr;
    case MeshUse::kWritten:
      return true;
    case MeshUse::kWrittenWithScalars:
      break;
  }
  return format.has_scalars;
}

const Format& format_of(const std::string& path, MeshUse use) {
  const Format* format = find_format(path);
  if (format == nullptr) {
    throw Failure{path + ": unknown format of meshes (known are " + mesh_suffixes(use) + ")"};
  }
  if (allows(*format, use)) return *format;
  if (use == MeshUse::kRead) {
    throw Failure{path + ": " + format->suffix + " is written only (read are " +
                  mesh_suffixes(use) + ")"};
  }
  throw Failure{path + ": this format has no values at vertices (" + mesh_suffixes(use) + " have)"};
}

const Format& format_for(const std::string& path, bool with_scalars) {
  return format_of(path, with_scalars ? MeshUse::kWrittenWithScalars : MeshUse::kWritten);
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

void MeshBuilder::scalars(std::string name, std::vector<float> values) {
  const bool taken = std::any_of(mesh_.scalars.begin(), mesh_.scalars.end(),
                                 [&](const Scalars& s) { return s.name == name; });
  if (is_scalar_name(name) && !taken) mesh_.scalars.push_back({std::move(name), std::move(values)});
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
  std::erase_if(mesh_.scalars, [&](const Scalars& s) { return s.values.size() != count; });
  return std::move(mesh_);
}

TriangleMesh read_mesh(const std::string& path) {
  const Format& format = format_of(path, MeshUse::kRead);
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

std::string space_comment(const TriangleMesh& mesh) {
  return mesh.space.empty() ? "" : "SPACE=" + mesh.space;
}

std::string space_in(std::string_view comment) {
  for (const char* name : {space_names::kLps, space_names::kRas, space_names::kVoxel}) {
    if (comment.find(std::string("SPACE=") + name) != std::string_view::npos) return name;
  }
  return {};
}

bool Scalars::are_labels() const {
  constexpr float kMost = 1 << 24;
  std::string lower = name;
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower.find("label") != std::string::npos &&
         std::all_of(values.begin(), values.end(), [](float x) {
           return !std::isfinite(x) || (x == std::trunc(x) && std::abs(x) <= kMost);
         });
}

bool is_scalar_name(std::string_view name) {
  constexpr size_t kLongest = 64;
  return !name.empty() && name.size() <= kLongest &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

bool is_mesh_path(const std::string& path) {
  return find_format(path) != nullptr;
}

bool holds_scalars(const std::string& path) {
  const Format* format = find_format(path);
  return format != nullptr && format->has_scalars;
}

std::string mesh_suffixes(MeshUse use) {
  std::string names;
  std::string last;
  for (const Format& format : kFormats) {
    if (!allows(format, use)) continue;
    if (!last.empty()) names += (names.empty() ? "" : ", ") + last;
    last = format.suffix;
  }
  return names + " and " + last;
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
  if (mesh.doubles && !format.has_doubles) {
    throw Failure{path + ": not written: this format has no doubles, and rounded to floats faces " +
                  "would meet; .ply and .vtp have, or --space voxel may hold the surface"};
  }
  format.write(files.add(path), mesh);
}

}  // namespace plc::tools
