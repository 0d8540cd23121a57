// Wavefront OBJ: v, vn and f; everything else is passed over.
#include <algorithm>
#include <vector>

#include "tools/file/text.h"
#include "tools/mesh/mesh_io_formats.h"

namespace plc::tools {
namespace {

// An index from 1, or from -1 backwards, as one from 0.
int64_t resolved(const TextReader& text, int64_t index, size_t count) {
  const int64_t from_zero = index < 0 ? static_cast<int64_t>(count) + index : index - 1;
  if (index == 0 || from_zero < 0) text.fail("there is no element " + std::to_string(index));
  return from_zero;
}

// As the comments before the first element name it.
std::string space_of_comments(std::string_view data) {
  while (!data.empty() && data.front() == '#') {
    const size_t end = std::min(data.find('\n'), data.size() - 1);
    std::string space = space_in(data.substr(0, end));
    if (!space.empty()) return space;
    data.remove_prefix(end + 1);
  }
  return {};
}

}  // namespace

TriangleMesh read_obj(const std::string& path, std::string_view data) {
  TextReader text(path, data, '#');
  MeshBuilder mesh(path);
  std::vector<double> normals;
  bool normals_match = true;  // each corner has the normal of its vertex's number
  std::vector<int64_t> corners;
  mesh.space(space_of_comments(data));
  while (!text.at_end()) {
    const std::string_view key = text.word();
    if (key == "v") {
      const double x = text.real();
      const double y = text.real();
      mesh.vertex(x, y, text.real());
    } else if (key == "vn") {
      for (int k = 0; k < 3; ++k) normals.push_back(text.real());
    } else if (key == "f") {
      corners.clear();
      while (!text.at_end_of_line()) {
        const std::string_view corner = text.word();  // v, v/t, v//n or v/t/n
        const size_t first = corner.find('/');
        const size_t last = corner.rfind('/');
        corners.push_back(
            resolved(text, text.to_integer(corner.substr(0, first)), mesh.vertex_count()));
        const bool has_normal = last != first && last + 1 < corner.size();
        normals_match = normals_match && has_normal &&
                        resolved(text, text.to_integer(corner.substr(last + 1)),
                                 normals.size() / 3) == corners.back();
      }
      if (corners.size() < 3) text.fail("a face of fewer than 3 corners");
      mesh.polygon(corners);
    } else if (key == "\\") {
      text.fail("lines that go on are not supported");
    }
    text.skip_line();
  }
  if (normals_match && normals.size() == 3 * mesh.vertex_count()) {
    for (size_t i = 0; i < normals.size(); i += 3) {
      mesh.normal(normals[i], normals[i + 1], normals[i + 2]);
    }
  }
  return mesh.finish();
}

void write_obj(AtomicFile& file, const TriangleMesh& mesh) {
  const bool with_normals = mesh.normals.size() == mesh.xyz.size();
  std::string out = "# Pellicle\n";
  if (!mesh.space.empty()) out += "# " + space_comment(mesh) + "\n";
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    if (i % 3 == 0) out += "v ";
    put_real(out, mesh.xyz[i], mesh.doubles);
    out += i % 3 == 2 ? '\n' : ' ';
    drain(file, out);
  }
  for (size_t i = 0; with_normals && i < mesh.normals.size(); ++i) {
    if (i % 3 == 0) out += "vn ";
    put_real(out, static_cast<double>(mesh.normals[i]));
    out += i % 3 == 2 ? '\n' : ' ';
    drain(file, out);
  }
  for (size_t i = 0; i < mesh.abc.size(); ++i) {
    if (i % 3 == 0) out += "f ";
    const uint64_t number = uint64_t{mesh.abc[i]} + 1;
    put_integer(out, number);
    if (with_normals) {
      out += "//";
      put_integer(out, number);
    }
    out += i % 3 == 2 ? '\n' : ' ';
    drain(file, out);
  }
  drain(file, out, true);
}

}  // namespace plc::tools
