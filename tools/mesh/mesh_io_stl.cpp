// STL, binary and ASCII. The corners of the triangles become vertices where they coincide exactly.
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

#include "tools/file/failure.h"
#include "tools/file/text.h"
#include "tools/mesh/mesh_io_formats.h"

namespace plc::tools {
namespace {

// Binary: a header of 80 bytes, u32 triangles; each a normal and three corners of 3 f32, and u16.
constexpr size_t kHeaderBytes = 80;
constexpr size_t kPreambleBytes = kHeaderBytes + sizeof(uint32_t);
constexpr size_t kTriangleBytes = 12 * sizeof(float) + sizeof(uint16_t);

class Welder {
 public:
  explicit Welder(MeshBuilder& mesh) : mesh_(mesh) {}
  int64_t vertex(double x, double y, double z) {
    const Key key{bits(x), bits(y), bits(z)};
    const auto [entry, is_new] = vertices_.try_emplace(key, mesh_.vertex_count());
    if (is_new) mesh_.vertex(x, y, z);
    return static_cast<int64_t>(entry->second);
  }

 private:
  struct Key {
    uint64_t x, y, z;
    bool operator==(const Key&) const = default;
  };
  struct Hash {
    size_t operator()(const Key& key) const {
      uint64_t hash = key.x;
      hash = (hash ^ (hash >> 32)) * 0x9e3779b97f4a7c15U + key.y;
      hash = (hash ^ (hash >> 29)) * 0xbf58476d1ce4e5b9U + key.z;
      hash = (hash ^ (hash >> 32)) * 0x94d049bb133111ebU;
      return hash ^ (hash >> 31);
    }
  };
  static uint64_t bits(double value) {
    return std::bit_cast<uint64_t>(value == 0 ? 0.0 : value);  // -0 is 0
  }
  MeshBuilder& mesh_;
  std::unordered_map<Key, size_t, Hash> vertices_;
};

TriangleMesh read_binary(const std::string& path, std::string_view data) {
  const uint64_t count = load_value<uint32_t>(data.data() + kHeaderBytes, false);
  if (data.size() < kPreambleBytes + count * kTriangleBytes) {
    throw Failure{path + ": is truncated (" + std::to_string(data.size()) + " bytes, " +
                  std::to_string(count) + " triangles need " +
                  std::to_string(kPreambleBytes + count * kTriangleBytes) + ")"};
  }
  MeshBuilder mesh(path);
  Welder welder(mesh);
  for (uint64_t i = 0; i < count; ++i) {
    const char* corner = data.data() + kPreambleBytes + i * kTriangleBytes + 3 * sizeof(float);
    int64_t abc[3];
    for (int64_t& vertex : abc) {
      vertex = welder.vertex(load_value<float>(corner, false), load_value<float>(corner + 4, false),
                             load_value<float>(corner + 8, false));
      corner += 3 * sizeof(float);
    }
    mesh.triangle(abc[0], abc[1], abc[2]);
  }
  return mesh.finish();
}

TriangleMesh read_ascii(const std::string& path, std::string_view data) {
  TextReader text(path, data);
  MeshBuilder mesh(path);
  Welder welder(mesh);
  text.skip_line();  // "solid" and a name
  bool complete = false;
  while (!text.at_end()) {
    const std::string_view word = text.word();
    complete = word == "endsolid";
    if (word == "solid" || word == "endsolid") {
      text.skip_line();
      continue;
    }
    if (word != "facet") text.fail("\"facet\" was expected");
    text.skip_line();  // the normal; it follows from the corners
    if (text.word() != "outer" || text.word() != "loop") text.fail("\"outer loop\" was expected");
    int64_t abc[3];
    for (int64_t& vertex : abc) {
      if (text.word() != "vertex") text.fail("\"vertex\" was expected");
      const double x = text.real();
      const double y = text.real();
      vertex = welder.vertex(x, y, text.real());
    }
    if (text.word() != "endloop" || text.word() != "endfacet") {
      text.fail("\"endloop endfacet\" was expected");
    }
    mesh.triangle(abc[0], abc[1], abc[2]);
  }
  if (!complete) text.fail("ends too early");
  return mesh.finish();
}

struct Triangle {
  const double* corner[3];
  double normal[3];  // of length 1, or 0
};

Triangle triangle_of(const TriangleMesh& mesh, size_t face) {
  Triangle t{};
  for (size_t k = 0; k < 3; ++k) {
    t.corner[k] = mesh.xyz.data() + 3 * size_t{mesh.abc[3 * face + k]};
  }
  double u[3];
  double v[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = t.corner[1][k] - t.corner[0][k];
    v[k] = t.corner[2][k] - t.corner[0][k];
  }
  const double n[3] = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                       u[0] * v[1] - u[1] * v[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (int k = 0; k < 3; ++k) t.normal[k] = length > 0 ? n[k] / length : 0;
  return t;
}

void write_binary(AtomicFile& file, const TriangleMesh& mesh) {
  const size_t count = mesh.abc.size() / 3;
  if (count > std::numeric_limits<uint32_t>::max()) {
    throw Failure{"an STL file cannot hold " + std::to_string(count) + " triangles"};
  }
  std::string out = "Binary STL by Pellicle, mm " + space_comment(mesh);
  out.resize(kHeaderBytes, ' ');
  put_value(out, static_cast<uint32_t>(count));
  for (size_t i = 0; i < count; ++i) {
    const Triangle t = triangle_of(mesh, i);
    for (const double component : t.normal) put_value(out, static_cast<float>(component));
    for (const double* corner : t.corner) {
      for (int k = 0; k < 3; ++k) put_value(out, static_cast<float>(corner[k]));
    }
    put_value(out, uint16_t{0});
    drain(file, out);
  }
  drain(file, out, true);
}

void put_vector(std::string& out, const double* v, bool exact) {
  for (int k = 0; k < 3; ++k) {
    out += ' ';
    put_real(out, v[k], exact);
  }
  out += '\n';
}

void write_ascii(AtomicFile& file, const TriangleMesh& mesh) {
  std::string out = "solid Pellicle " + space_comment(mesh) + "\n";
  for (size_t i = 0; i < mesh.abc.size() / 3; ++i) {
    const Triangle t = triangle_of(mesh, i);
    out += "facet normal";
    put_vector(out, t.normal, false);
    out += "outer loop\n";
    for (const double* corner : t.corner) {
      out += "vertex";
      put_vector(out, corner, true);
    }
    out += "endloop\nendfacet\n";
    drain(file, out);
  }
  out += "endsolid Pellicle\n";
  drain(file, out, true);
}

}  // namespace

namespace {

TriangleMesh read_either(const std::string& path, std::string_view data) {
  // Binary files may begin with "solid" too: their size tells them apart.
  if (data.size() >= kPreambleBytes) {
    const uint64_t count = load_value<uint32_t>(data.data() + kHeaderBytes, false);
    if (data.size() == kPreambleBytes + count * kTriangleBytes) return read_binary(path, data);
  }
  if (data.starts_with("solid")) return read_ascii(path, data);
  if (data.size() < kPreambleBytes) throw Failure{path + ": is truncated"};
  return read_binary(path, data);
}

}  // namespace

TriangleMesh read_stl(const std::string& path, std::string_view data) {
  TriangleMesh mesh = read_either(path, data);
  // In the 80 bytes before all else, or in the first line of text.
  mesh.space = space_in(data.substr(0, std::min<size_t>(data.find('\n'), kHeaderBytes)));
  return mesh;
}

// The binary kind has floats only.
void write_stl(AtomicFile& file, const TriangleMesh& mesh) {
  if (mesh.doubles) {
    write_ascii(file, mesh);
  } else {
    write_binary(file, mesh);
  }
}

}  // namespace plc::tools
