// GLB, glTF 2.0 in one file: for web pages, Blender, PowerPoint, AR. A description in JSON, then a
// block of the arrays that it names. Positions stay the floats of the mesh; a node turns and scales
// them, as glTF has metres, y up and z to the front. The first values, or labels, become colours,
// and each label of a table becomes a node of that name.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/file/failure.h"
#include "tools/file/text.h"
#include "tools/mesh/mesh_io_formats.h"
#include "tools/mesh/vertex_colours.h"

namespace plc::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kUnsignedByte = 5121;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;

// Column by column: mm of the mesh's space to metres of glTF; voxels are taken as they are.
Json matrix_of(const std::string& space) {
  constexpr double kMetre = 0.001;
  if (space == space_names::kVoxel) return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
  const double m = kMetre;
  if (space == space_names::kRas) return {-m, 0, 0, 0, 0, 0, m, 0, 0, m, 0, 0, 0, 0, 0, 1};
  return {m, 0, 0, 0, 0, 0, -m, 0, 0, m, 0, 0, 0, 0, 0, 1};
}

uint8_t byte_of(double part) {
  return static_cast<uint8_t>(std::lround(std::clamp(part, 0.0, 1.0) * 255));
}

// The block of arrays, and what the description says of it.
class Arrays {
 public:
  template <typename T, typename Values>
  int add(const char* type, int component, int target, size_t count, const Values& values) {
    const size_t begin = bytes_.size();
    for (const auto value : values) put_value(bytes_, static_cast<T>(value));
    views_.push_back({{"buffer", 0},
                      {"byteOffset", begin},
                      {"byteLength", bytes_.size() - begin},
                      {"target", target}});
    bytes_.resize((bytes_.size() + 3) / 4 * 4);
    accessors_.push_back({{"bufferView", views_.size() - 1},
                          {"componentType", component},
                          {"count", count},
                          {"type", type}});
    return static_cast<int>(accessors_.size()) - 1;
  }
  Json& accessor(int index) { return accessors_[static_cast<size_t>(index)]; }
  const std::string& bytes() const { return bytes_; }
  Json views() const { return views_; }
  Json accessors() const { return accessors_; }

 private:
  std::string bytes_;
  Json views_ = Json::array();
  Json accessors_ = Json::array();
};

int add_positions(Arrays& arrays, const TriangleMesh& mesh) {
  const int index = arrays.add<float>("VEC3", kFloat, kArrayBuffer, mesh.xyz.size() / 3, mesh.xyz);
  std::array<double, 3> low = {mesh.xyz[0], mesh.xyz[1], mesh.xyz[2]};
  std::array<double, 3> high = low;
  for (size_t i = 0; i < mesh.xyz.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], mesh.xyz[i]);
    high[i % 3] = std::max(high[i % 3], mesh.xyz[i]);
  }
  for (size_t k = 0; k < 3; ++k) {
    arrays.accessor(index)["min"].push_back(static_cast<float>(low[k]));
    arrays.accessor(index)["max"].push_back(static_cast<float>(high[k]));
  }
  return index;
}

// Without values the material has a colour of its own.
int add_colours(Arrays& arrays, const TriangleMesh& mesh) {
  std::vector<uint8_t> bytes;
  for (const Rgb& rgb : vertex_colours(mesh)) {
    for (const double x : rgb) bytes.push_back(byte_of(x));
    bytes.push_back(255);
  }
  const int index =
      arrays.add<uint8_t>("VEC4", kUnsignedByte, kArrayBuffer, mesh.xyz.size() / 3, bytes);
  arrays.accessor(index)["normalized"] = true;
  return index;
}

Json attributes_of(Arrays& arrays, const TriangleMesh& mesh) {
  Json attributes = {{"POSITION", add_positions(arrays, mesh)}};
  const size_t vertices = mesh.xyz.size() / 3;
  if (mesh.normals.size() == mesh.xyz.size()) {
    attributes["NORMAL"] = arrays.add<float>("VEC3", kFloat, kArrayBuffer, vertices, mesh.normals);
  }
  if (!mesh.scalars.empty()) attributes["COLOR_0"] = add_colours(arrays, mesh);
  for (const Scalars& scalars : mesh.scalars) {
    std::string name = "_" + scalars.name;  // as an application's own must begin, in capitals
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
    std::string free = name;  // names that differ in case alone are one then
    for (int k = 2; attributes.contains(free); ++k) free = name + "_" + std::to_string(k);
    // glTF has no NaN.
    std::vector<float> values = scalars.values;
    for (float& value : values) value = std::isfinite(value) ? value : 0;
    attributes[free] = arrays.add<float>("SCALAR", kFloat, kArrayBuffer, vertices, values);
  }
  return attributes;
}

// The faces of each label, told by their first corner, and what it is called; all faces, without a
// name, where there is no table.
struct Part {
  std::string name;
  Json extras;
  std::vector<uint32_t> abc;
};

std::vector<Part> parts_of(const TriangleMesh& mesh) {
  if (mesh.labels.empty()) return {{"", {}, mesh.abc}};
  std::vector<Part> parts;
  std::map<int32_t, size_t> part_of;
  for (const LabelInfo& label : mesh.labels) {
    part_of[label.value] = parts.size();
    const std::string name = label.name.empty() ? std::to_string(label.value) : label.name;
    parts.push_back({name, {{"label", label.value}}, {}});
  }
  for (size_t i = 0; i < mesh.abc.size(); i += 3) {
    const auto label = static_cast<int32_t>(mesh.scalars[0].values[mesh.abc[i]]);
    std::vector<uint32_t>& abc = parts[part_of.at(label)].abc;
    abc.insert(abc.end(), mesh.abc.begin() + static_cast<ptrdiff_t>(i),
               mesh.abc.begin() + static_cast<ptrdiff_t>(i) + 3);
  }
  std::erase_if(parts, [](const Part& part) { return part.abc.empty(); });
  return parts;
}

// A node that turns all to metres, and below it one for each named part. All share the vertices.
void add_nodes(Arrays& arrays, const TriangleMesh& mesh, Json& root, Json& nodes, Json& meshes) {
  const Json attributes = attributes_of(arrays, mesh);
  for (const Part& part : parts_of(mesh)) {
    const int corners = arrays.add<uint32_t>("SCALAR", kUnsignedInt, kElementArrayBuffer,
                                             part.abc.size(), part.abc);
    const Json primitive = {{"attributes", attributes}, {"indices", corners}, {"material", 0}};
    Json node = {{"mesh", meshes.size()}};
    Json shape = {{"primitives", {primitive}}};
    if (mesh.labels.empty()) {
      root["mesh"] = 0;
    } else {
      shape["name"] = node["name"] = part.name;
      node["extras"] = part.extras;
      root["children"].push_back(nodes.size() + 1);
      nodes.push_back(node);
    }
    meshes.push_back(shape);
  }
}

Json description_of(Arrays& arrays, const TriangleMesh& mesh) {
  Json extras = {{"space", mesh.space}, {"unit", mesh.space == space_names::kVoxel ? "" : "mm"}};
  if (!mesh.scalars.empty() && !mesh.scalars[0].are_labels()) {
    const ColourRange range = colour_range(mesh.scalars[0]);
    extras["colours"] = {{"of", mesh.scalars[0].name}, {"low", range.low}, {"high", range.high}};
  }
  const Json colour = mesh.scalars.empty() ? Json{0.79, 0.75, 0.65, 1.0} : Json{1.0, 1.0, 1.0, 1.0};
  const Json asset = {{"version", "2.0"}, {"generator", "Pellicle"}};
  if (mesh.abc.empty()) return {{"asset", asset}};  // an array of nothing is none
  Json root = Json::object();
  Json below = Json::array();
  Json meshes = Json::array();
  add_nodes(arrays, mesh, root, below, meshes);
  root["matrix"] = matrix_of(mesh.space);
  root["extras"] = extras;
  Json nodes = Json::array({root});
  nodes.insert(nodes.end(), below.begin(), below.end());
  return {{"asset", asset},
          {"scene", 0},
          {"scenes", {{{"nodes", {0}}}}},
          {"nodes", nodes},
          {"meshes", meshes},
          {"materials",
           {{{"pbrMetallicRoughness",
              {{"baseColorFactor", colour}, {"metallicFactor", 0}, {"roughnessFactor", 0.7}}}}}},
          {"buffers", {{{"byteLength", arrays.bytes().size()}}}},
          {"bufferViews", arrays.views()},
          {"accessors", arrays.accessors()}};
}

}  // namespace

void write_glb(AtomicFile& file, const TriangleMesh& mesh) {
  constexpr size_t kHeader = 12;
  constexpr size_t kChunkHeader = 8;
  Arrays arrays;
  std::string json = description_of(arrays, mesh).dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string& block = arrays.bytes();
  const size_t size =
      kHeader + kChunkHeader + json.size() + (block.empty() ? 0 : kChunkHeader + block.size());
  if (size > std::numeric_limits<uint32_t>::max()) {
    throw Failure{"a GLB file cannot hold " + std::to_string(mesh.xyz.size() / 3) + " vertices"};
  }
  std::string out = "glTF";
  put_value(out, uint32_t{2});
  put_value(out, static_cast<uint32_t>(size));
  put_value(out, static_cast<uint32_t>(json.size()));
  out += "JSON" + json;
  if (!block.empty()) {
    put_value(out, static_cast<uint32_t>(block.size()));
    out += std::string("BIN\0", 4);
  }
  drain(file, out, true);
  file.write(block);
}

}  // namespace plc::tools
