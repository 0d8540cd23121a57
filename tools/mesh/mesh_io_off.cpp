// OFF: a keyword, counts, then a line per vertex and per face.
#include <vector>

#include "tools/file/text.h"
#include "tools/mesh/mesh_io_formats.h"

namespace plc::tools {

TriangleMesh read_off(const std::string& path, std::string_view data) {
  TextReader text(path, data, '#');
  const std::string_view keyword = text.word();
  // Normals (N) and colours (C) follow the position in its line and are not read; texture
  // coordinates, too. 4 and n change the position itself.
  if (keyword != "OFF" && keyword != "COFF" && keyword != "NOFF" && keyword != "CNOFF" &&
      keyword != "STOFF") {
    text.fail("\"OFF\" was expected");
  }
  if (!text.at_end_of_line() && text.remaining() >= 6 &&
      data.substr(text.position(), 6) == "BINARY") {
    text.fail("binary OFF is not supported");
  }
  const int64_t vertices = text.integer();
  const int64_t faces = text.integer();
  text.skip_line();  // the number of edges, where it is given
  // "0 0 0\n" and "3 0 1 2\n" less the last newline.
  if (vertices < 0 || faces < 0 || vertices > static_cast<int64_t>(data.size() / 5) ||
      faces > static_cast<int64_t>(data.size() / 7)) {
    text.fail("the file cannot hold " + std::to_string(vertices) + " vertices and " +
              std::to_string(faces) + " faces");
  }
  MeshBuilder mesh(path);
  for (int64_t i = 0; i < vertices; ++i) {
    const double x = text.real();
    const double y = text.real();
    mesh.vertex(x, y, text.real());
    text.skip_line();
  }
  std::vector<int64_t> corners;
  for (int64_t i = 0; i < faces; ++i) {
    const int64_t count = text.integer();
    if (count < 3 || count > static_cast<int64_t>(text.remaining() / 2 + 1)) {
      text.fail("a face of " + std::to_string(count) + " corners");
    }
    corners.clear();
    for (int64_t k = 0; k < count; ++k) corners.push_back(text.integer());
    mesh.polygon(corners);
    text.skip_line();
  }
  return mesh.finish();
}

void write_off(AtomicFile& file, const TriangleMesh& mesh) {
  std::string out = "OFF\n";
  put_integer(out, mesh.xyz.size() / 3);
  out += ' ';
  put_integer(out, mesh.abc.size() / 3);
  out += " 0\n";
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    put_real(out, mesh.xyz[i], mesh.doubles);
    out += i % 3 == 2 ? '\n' : ' ';
    drain(file, out);
  }
  for (size_t i = 0; i < mesh.abc.size(); ++i) {
    if (i % 3 == 0) out += "3 ";
    put_integer(out, mesh.abc[i]);
    out += i % 3 == 2 ? '\n' : ' ';
    drain(file, out);
  }
  drain(file, out, true);
}

}  // namespace plc::tools
