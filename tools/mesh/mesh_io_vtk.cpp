// VTK's legacy PolyData (.vtk): written in binary, version 3.0, which all that read it know; read
// in ASCII and binary, with the cells of versions before and from 5.0. What follows colours,
// vectors, tensors or values of cells is passed over.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"
#include "tools/file/memory.h"
#include "tools/file/printable.h"
#include "tools/file/text.h"
#include "tools/mesh/mesh_io_formats.h"

namespace plc::tools {
namespace {

// ---- reading --------------------------------------------------------------------------------

struct ValueType {
  std::string_view name;
  size_t size;
  double (*load)(const char* at);
};

template <typename T>
double load_big(const char* at) {
  return static_cast<double>(load_value<T>(at, true));
}

constexpr ValueType kValueTypes[] = {
    {"float", 4, load_big<float>},           {"double", 8, load_big<double>},
    {"int", 4, load_big<int32_t>},           {"unsigned_int", 4, load_big<uint32_t>},
    {"short", 2, load_big<int16_t>},         {"unsigned_short", 2, load_big<uint16_t>},
    {"char", 1, load_big<int8_t>},           {"unsigned_char", 1, load_big<uint8_t>},
    {"vtktypeint64", 8, load_big<int64_t>},  {"vtktypeint32", 4, load_big<int32_t>},
    {"vtkIdType", 4, load_big<int32_t>},     {"long", 8, load_big<int64_t>},
    {"unsigned_long", 8, load_big<uint64_t>}};

const ValueType* find_type(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kValueTypes), std::end(kValueTypes),
                                         [&](const ValueType& t) { return t.name == name; });
  return found == std::end(kValueTypes) ? nullptr : found;
}

struct Cells {
  std::vector<double> offsets, corners;  // of cell i: corners offsets[i] .. offsets[i + 1]
};

class VtkReader {
 public:
  VtkReader(const std::string& path, std::string_view data)
      : path_(path), data_(data), text_(path, data), mesh_(path) {}

  TriangleMesh read() {
    read_header();
    while (!text_.at_end() && section()) {
    }
    if (!has_points_) throw Failure{path_ + ": has no points"};
    for_each_cell(polygons_, [&](const std::vector<int64_t>& c) { mesh_.polygon(c); });
    for_each_cell(strips_, [&](const std::vector<int64_t>& c) {
      for (size_t i = 2; i < c.size(); ++i) {  // every second triangle is turned over
        mesh_.triangle(c[i - 2], c[i - 1 + i % 2], c[i - i % 2]);
      }
    });
    return mesh_.finish();
  }

 private:
  std::string_view line() {
    const std::string_view rest = data_.substr(text_.position());
    text_.skip_line();
    return rest.substr(0, rest.find('\n'));
  }

  void read_header() {
    const std::string_view first = line();
    if (!first.starts_with("# vtk DataFile Version ")) text_.fail("is not a file of VTK");
    new_cells_ = first.substr(23) >= "5";
    mesh_.space(space_in(line()));
    const std::string_view encoding = text_.word();
    binary_ = encoding == "BINARY";
    if (!binary_ && encoding != "ASCII") text_.fail("neither ASCII nor BINARY");
    if (text_.word() != "DATASET" || text_.word() != "POLYDATA") {
      text_.fail("no DATASET POLYDATA");
    }
  }

  // False: it and all behind it is passed over.
  bool section() {
    const std::string_view key = text_.word();
    if (key == "POINTS") {
      points();
    } else if (key == "POLYGONS") {
      cells(polygons_);
    } else if (key == "TRIANGLE_STRIPS") {
      cells(strips_);
    } else if (key == "VERTICES" || key == "LINES") {
      Cells passed_over;
      cells(passed_over);
    } else if (key == "POINT_DATA") {
      at_points_ = true;
      text_.integer();
    } else if (key == "NORMALS") {
      normals();
    } else if (key == "SCALARS") {
      scalars();
    } else if (key == "METADATA") {
      skip_metadata();
    } else if (key == "FIELD") {
      fields();
    } else {
      static constexpr std::string_view kLast[] = {
          "CELL_DATA",    "COLOR_SCALARS",      "VECTORS", "TENSORS", "TENSORS6",
          "LOOKUP_TABLE", "TEXTURE_COORDINATES"};
      if (std::find(std::begin(kLast), std::end(kLast), key) == std::end(kLast)) {
        text_.fail("unknown keyword " + printable(key));
      }
      return false;
    }
    return true;
  }

  // Up to an empty line.
  void skip_metadata() {
    text_.skip_line();
    while (text_.remaining() > 0) {
      const std::string_view next = line();
      if (next.empty() || next == "\r") return;
    }
  }

  uint64_t size() {
    const int64_t value = text_.integer();
    if (value < 0) text_.fail("a negative number");
    return static_cast<uint64_t>(value);
  }

  std::vector<double> values(uint64_t count, std::string_view type_name) {
    const ValueType* type = find_type(type_name);
    if (type == nullptr) text_.fail("unknown type " + printable(type_name));
    const uint64_t bytes = binary_ ? times(count, type->size) : times(count, 2);
    if (binary_) text_.skip_line();
    if (bytes > plus(text_.remaining(), binary_ ? 0 : 1)) throw Failure{path_ + ": is truncated"};
    require_memory(path_, times(count, sizeof(double)));
    std::vector<double> out(count);
    if (!binary_) {
      for (double& value : out) value = text_.real();
      return out;
    }
    const char* at = data_.data() + text_.position();
    for (size_t i = 0; i < count; ++i) out[i] = type->load(at + i * type->size);
    text_.skip(bytes);
    return out;
  }

  void points() {
    const uint64_t count = size();
    const std::vector<double> xyz = values(times(count, 3), text_.word());
    if (has_points_) throw Failure{path_ + ": has points twice"};
    has_points_ = true;
    for (size_t i = 0; i < xyz.size(); i += 3) mesh_.vertex(xyz[i], xyz[i + 1], xyz[i + 2]);
  }

  void cells(Cells& out) {
    const uint64_t first = size();
    const uint64_t second = size();
    if (new_cells_) {
      if (text_.word() != "OFFSETS") text_.fail("OFFSETS was expected");
      out.offsets = values(first, text_.word());
      if (text_.word() != "CONNECTIVITY") text_.fail("CONNECTIVITY was expected");
      out.corners = values(second, text_.word());
      return;
    }
    // Of each cell how many corners it has, and they.
    out.corners = values(second, "int");
    out.offsets.assign(1, 0);
    std::vector<double> corners;
    for (size_t i = 0; i < out.corners.size();) {
      const double n = out.corners[i];
      if (!(n >= 0 && n < static_cast<double>(out.corners.size() - i))) {
        throw Failure{path_ + ": its cells do not fit their number"};
      }
      const auto begin = out.corners.begin() + static_cast<std::ptrdiff_t>(i) + 1;
      corners.insert(corners.end(), begin, begin + static_cast<std::ptrdiff_t>(n));
      out.offsets.push_back(static_cast<double>(corners.size()));
      i += static_cast<size_t>(n) + 1;
    }
    if (out.offsets.size() != plus(first, 1)) {
      throw Failure{path_ + ": its cells do not fit their number"};
    }
    out.corners = std::move(corners);
  }

  void normals() {
    text_.word();
    const std::vector<double> n = values(times(mesh_.vertex_count(), 3), text_.word());
    if (!at_points_) return;
    for (size_t i = 0; i < n.size(); i += 3) mesh_.normal(n[i], n[i + 1], n[i + 2]);
  }

  void scalars() {
    const std::string name(text_.word());
    const std::string type(text_.word());
    const uint64_t components = text_.at_end_of_line() ? 1 : size();
    if (text_.word() != "LOOKUP_TABLE") text_.fail("LOOKUP_TABLE was expected");
    text_.word();
    keep(name, values(times(mesh_.vertex_count(), components), type));
  }

  // A name, how many arrays, and of each its name, components, tuples and type.
  void fields() {
    text_.word();
    for (uint64_t left = size(); left > 0; --left) {
      const std::string name(text_.word());
      if (name == "METADATA") {
        skip_metadata();
        ++left;
        continue;
      }
      const uint64_t components = size();
      const uint64_t tuples = size();
      keep(name, values(times(components, tuples), text_.word()));
    }
  }

  void keep(const std::string& name, const std::vector<double>& wide) {
    if (!at_points_ || wide.size() != mesh_.vertex_count()) return;
    std::vector<float> narrow(wide.size());
    std::transform(wide.begin(), wide.end(), narrow.begin(),
                   [](double x) { return static_cast<float>(x); });
    mesh_.scalars(name, std::move(narrow));
  }

  template <typename Visit>
  void for_each_cell(const Cells& cells, const Visit& visit) {
    std::vector<int64_t> corners;
    for (size_t i = 1; i < cells.offsets.size(); ++i) {
      const double begin = cells.offsets[i - 1];
      const double end = cells.offsets[i];
      if (!(begin >= 0 && begin <= end && end <= static_cast<double>(cells.corners.size()))) {
        throw Failure{path_ + ": the offsets of its cells do not fit their corners"};
      }
      corners.clear();
      for (auto k = static_cast<size_t>(begin); k < static_cast<size_t>(end); ++k) {
        const double v = cells.corners[k];
        if (!(v >= 0 && v < static_cast<double>(mesh_.vertex_count())) || v != std::floor(v)) {
          throw Failure{path_ + ": a cell refers to a point that is not there"};
        }
        corners.push_back(static_cast<int64_t>(v));
      }
      visit(corners);
    }
  }

  const std::string& path_;
  std::string_view data_;
  TextReader text_;
  MeshBuilder mesh_;
  Cells polygons_, strips_;
  bool binary_ = false;
  bool new_cells_ = false;
  bool has_points_ = false;
  bool at_points_ = false;  // what follows are values at points
};

// ---- writing --------------------------------------------------------------------------------

// In big endian, as VTK has it.
template <typename T>
void put_big(std::string& out, T value) {
  const size_t begin = out.size();
  put_value(out, value);
  std::reverse(out.begin() + static_cast<std::ptrdiff_t>(begin), out.end());
}

template <typename T, typename Values>
void write_values(AtomicFile& file, std::string& out, const Values& values) {
  for (const auto value : values) {
    put_big(out, static_cast<T>(value));
    drain(file, out);
  }
  out += '\n';
}

}  // namespace

TriangleMesh read_vtk(const std::string& path, std::string_view data) {
  return VtkReader(path, data).read();
}

void write_vtk(AtomicFile& file, const TriangleMesh& mesh) {
  const size_t vertices = mesh.xyz.size() / 3;
  const size_t faces = mesh.abc.size() / 3;
  constexpr size_t kMost = std::numeric_limits<int32_t>::max();
  if (vertices > kMost || faces > kMost / 4) {
    throw Failure{"a VTK file of this kind cannot hold " + std::to_string(vertices) +
                  " vertices and " + std::to_string(faces) + " faces"};
  }
  std::string out = "# vtk DataFile Version 3.0\nPellicle " + space_comment(mesh) +
                    "\nBINARY\nDATASET POLYDATA\nPOINTS " + std::to_string(vertices) +
                    (mesh.doubles ? " double\n" : " float\n");
  if (mesh.doubles) {
    write_values<double>(file, out, mesh.xyz);
  } else {
    write_values<float>(file, out, mesh.xyz);
  }
  out += "POLYGONS " + std::to_string(faces) + " " + std::to_string(4 * faces) + "\n";
  for (size_t i = 0; i < mesh.abc.size(); ++i) {
    if (i % 3 == 0) put_big(out, int32_t{3});
    put_big(out, static_cast<int32_t>(mesh.abc[i]));
    drain(file, out);
  }
  out += '\n';
  const bool with_normals = vertices > 0 && mesh.normals.size() == mesh.xyz.size();
  if (with_normals || !mesh.scalars.empty()) {
    out += "POINT_DATA " + std::to_string(vertices) + "\n";
  }
  for (const Scalars& scalars : mesh.scalars) {
    out += "SCALARS " + scalars.name + " float 1\nLOOKUP_TABLE default\n";
    write_values<float>(file, out, scalars.values);
  }
  if (with_normals) {
    out += "NORMALS Normals float\n";
    write_values<float>(file, out, mesh.normals);
  }
  drain(file, out, true);
}

}  // namespace plc::tools
