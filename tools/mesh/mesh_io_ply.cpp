// PLY: ASCII, little and big endian, any properties; vertex x y z, perhaps nx ny nz, and faces.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tools/file/failure.h"
#include "tools/file/printable.h"
#include "tools/file/text.h"
#include "tools/mesh/mesh_io_formats.h"
#include "tools/mesh/vertex_colours.h"

namespace plc::tools {
namespace {

void put_coordinate(std::string& out, double value, bool exact) {
  if (exact) {
    put_value(out, value);
  } else {
    put_value(out, static_cast<float>(value));
  }
}

enum class Encoding { kAscii, kLittle, kBig };

enum class Scalar { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

size_t scalar_size(Scalar scalar) {
  constexpr size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<size_t>(scalar)];
}

std::optional<Scalar> scalar_of(std::string_view name) {
  struct Name {
    std::string_view name;
    Scalar scalar;
  };
  static constexpr Name kNames[] = {
      {"char", Scalar::kI8},    {"int8", Scalar::kI8},     {"uchar", Scalar::kU8},
      {"uint8", Scalar::kU8},   {"short", Scalar::kI16},   {"int16", Scalar::kI16},
      {"ushort", Scalar::kU16}, {"uint16", Scalar::kU16},  {"int", Scalar::kI32},
      {"int32", Scalar::kI32},  {"uint", Scalar::kU32},    {"uint32", Scalar::kU32},
      {"float", Scalar::kF32},  {"float32", Scalar::kF32}, {"double", Scalar::kF64},
      {"float64", Scalar::kF64}};
  for (const Name& entry : kNames) {
    if (entry.name == name) return entry.scalar;
  }
  return std::nullopt;
}

struct Property {
  std::string name;
  Scalar scalar = Scalar::kF32;
  std::optional<Scalar> count;  // of a list
};

struct Element {
  std::string name;
  int64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::kAscii;
  std::vector<Element> elements;
  std::string space;  // as a comment names it
  size_t size = 0;    // bytes
  int lines = 0;
};

Scalar scalar_named(const TextReader& text, std::string_view name) {
  const std::optional<Scalar> scalar = scalar_of(name);
  if (!scalar) text.fail("unknown type \"" + std::string(name.substr(0, 40)) + "\"");
  return *scalar;
}

Scalar read_scalar_name(TextReader& text) {
  return scalar_named(text, text.word());
}

Property read_property(TextReader& text) {
  Property property;
  const std::string_view type = text.word();
  if (type == "list") {
    property.count = read_scalar_name(text);
    property.scalar = read_scalar_name(text);
  } else {
    property.scalar = scalar_named(text, type);
  }
  property.name = text.word();
  return property;
}

Header read_header(const std::string& path, std::string_view data) {
  TextReader text(path, data);
  Header header;
  if (text.word() != "ply") text.fail("\"ply\" was expected");
  bool has_format = false;
  for (;;) {
    const std::string_view key = text.word();
    if (key == "end_header") break;
    if (key == "format") {
      const std::string_view name = text.word();
      has_format = true;
      if (name == "binary_little_endian") {
        header.encoding = Encoding::kLittle;
      } else if (name == "binary_big_endian") {
        header.encoding = Encoding::kBig;
      } else if (name != "ascii") {
        text.fail("unknown format \"" + std::string(name.substr(0, 40)) + "\"");
      }
    } else if (key == "element") {
      Element element;
      element.name = text.word();
      element.count = text.integer();
      if (element.count < 0) text.fail("a negative number of elements");
      header.elements.push_back(std::move(element));
    } else if (key == "property") {
      if (header.elements.empty()) text.fail("a property of no element");
      header.elements.back().properties.push_back(read_property(text));
    } else if (key == "comment") {
      const std::string_view rest = data.substr(text.position());
      const std::string space = space_in(rest.substr(0, rest.find('\n')));
      if (!space.empty()) header.space = space;
    } else if (key != "obj_info") {
      text.fail("unknown keyword \"" + std::string(key.substr(0, 40)) + "\"");
    }
    text.skip_line();
  }
  if (!has_format) text.fail("the header has no format");
  text.skip_line();
  header.size = text.position();
  header.lines = text.line();
  return header;
}

// Values one after the other, of either encoding.
class Values {
 public:
  Values(const std::string& path, std::string_view data, const Header& header)
      : path_(path),
        data_(data.substr(header.size)),
        text_(path, data_, '\0', header.lines),
        encoding_(header.encoding) {}

  double next(Scalar scalar) {
    if (encoding_ == Encoding::kAscii) return text_.real();
    const size_t size = scalar_size(scalar);
    if (data_.size() - next_ < size) throw Failure{path_ + ": is truncated"};
    const char* at = data_.data() + next_;
    next_ += size;
    return value_at(at, scalar, encoding_ == Encoding::kBig);
  }
  // Bytes left for values that take at least min_size each in the binary encodings.
  bool can_hold(uint64_t count, uint64_t min_size) const {
    if (encoding_ == Encoding::kAscii) return count <= text_.remaining() / 2 + 1;
    return min_size == 0 || count <= (data_.size() - next_) / min_size;
  }

 private:
  static double value_at(const char* at, Scalar scalar, bool big) {
    switch (scalar) {
      case Scalar::kI8:
        return load_value<int8_t>(at, big);
      case Scalar::kU8:
        return load_value<uint8_t>(at, big);
      case Scalar::kI16:
        return load_value<int16_t>(at, big);
      case Scalar::kU16:
        return load_value<uint16_t>(at, big);
      case Scalar::kI32:
        return load_value<int32_t>(at, big);
      case Scalar::kU32:
        return load_value<uint32_t>(at, big);
      case Scalar::kF32:
        return static_cast<double>(load_value<float>(at, big));
      case Scalar::kF64:
        return load_value<double>(at, big);
    }
    return 0;
  }
  const std::string& path_;
  std::string_view data_;
  size_t next_ = 0;
  TextReader text_;
  Encoding encoding_;
};

int64_t as_index(const std::string& path, double value) {
  constexpr double kLimit = 4294967296.0;
  if (!(value >= 0 && value < kLimit) || value != std::floor(value)) {
    throw Failure{path + ": a face refers to a vertex that is no vertex's number"};
  }
  return static_cast<int64_t>(value);
}

class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view data)
      : path_(path), header_(read_header(path, data)), values_(path, data, header_), mesh_(path) {}

  TriangleMesh read() {
    bool has_vertices = false;
    for (const Element& element : header_.elements) {
      check_count(element);
      if (element.properties.empty()) continue;  // nothing of it is in the file
      if (element.name == "vertex") {
        read_vertices(element);
        has_vertices = true;
      } else {
        read_others(element);
      }
    }
    if (!has_vertices) throw Failure{path_ + ": has no vertices"};
    mesh_.space(header_.space);
    return mesh_.finish();
  }

 private:
  void check_count(const Element& element) const {
    uint64_t size = 0;
    for (const Property& property : element.properties) {
      size += scalar_size(property.count.value_or(property.scalar));
    }
    if (!element.properties.empty() &&
        !values_.can_hold(static_cast<uint64_t>(element.count), size)) {
      throw Failure{path_ + ": is truncated (the rest cannot hold " +
                    std::to_string(element.count) + " of " + printable(element.name) + ")"};
    }
  }
  void read_vertices(const Element& element) {
    static constexpr std::string_view kNames[] = {"x", "y", "z", "nx", "ny", "nz"};
    double slots[7] = {};  // the last takes what is not asked for
    std::vector<double*> target;
    std::vector<std::vector<float>> values(element.properties.size());
    std::vector<char> is_value;
    int found = 0;
    for (const Property& property : element.properties) {
      if (property.count) throw Failure{path_ + ": has lists at its vertices"};
      const auto* const name = std::find(std::begin(kNames), std::end(kNames), property.name);
      target.push_back(slots + (name - std::begin(kNames)));
      if (name != std::end(kNames)) found |= 1 << (name - std::begin(kNames));
      // Not the bytes of colours.
      is_value.push_back(name == std::end(kNames) && scalar_size(property.scalar) >= 4 ? 1 : 0);
    }
    if ((found & 7) != 7) throw Failure{path_ + ": its vertices have no x, y and z"};
    const bool with_normals = found == 63;
    for (int64_t i = 0; i < element.count; ++i) {
      for (size_t k = 0; k < target.size(); ++k) {
        *target[k] = values_.next(element.properties[k].scalar);
        if (is_value[k] != 0) values[k].push_back(static_cast<float>(*target[k]));
      }
      mesh_.vertex(slots[0], slots[1], slots[2]);
      if (with_normals) mesh_.normal(slots[3], slots[4], slots[5]);
    }
    for (size_t k = 0; k < values.size(); ++k) {
      if (is_value[k] != 0) mesh_.scalars(element.properties[k].name, std::move(values[k]));
    }
  }
  void read_others(const Element& element) {
    std::vector<int64_t> corners;
    for (int64_t i = 0; i < element.count; ++i) {
      for (const Property& property : element.properties) {
        if (!property.count) {
          values_.next(property.scalar);
          continue;
        }
        const bool is_face = element.name == "face" &&
                             (property.name == "vertex_indices" || property.name == "vertex_index");
        const double count = values_.next(*property.count);
        if (!(count >= 0 && count < 4294967296.0) ||
            !values_.can_hold(static_cast<uint64_t>(count), scalar_size(property.scalar))) {
          throw Failure{path_ + ": is truncated or has a list of impossible length"};
        }
        corners.clear();
        for (auto left = static_cast<int64_t>(count); left > 0; --left) {
          const double value = values_.next(property.scalar);
          if (is_face) corners.push_back(as_index(path_, value));
        }
        if (is_face) mesh_.polygon(corners);
      }
    }
  }

  const std::string& path_;
  Header header_;
  Values values_;
  MeshBuilder mesh_;
};

}  // namespace

TriangleMesh read_ply(const std::string& path, std::string_view data) {
  return PlyReader(path, data).read();
}

void write_ply(AtomicFile& file, const TriangleMesh& mesh) {
  const bool with_normals = mesh.normals.size() == mesh.xyz.size();
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment Pellicle\n";
  if (!mesh.space.empty()) out += "comment " + space_comment(mesh) + "\n";
  for (const LabelInfo& label : mesh.labels) {
    out += "comment label " + std::to_string(label.value);
    for (const uint8_t part : label.rgb) out += " " + std::to_string(part);
    out += " " + label.name + "\n";
  }
  out += "element vertex ";
  put_integer(out, mesh.xyz.size() / 3);
  out += '\n';
  for (const char* axis : {"x\n", "y\n", "z\n"}) {
    out += mesh.doubles ? "property double " : "property float ";
    out += axis;
  }
  if (with_normals) out += "property float nx\nproperty float ny\nproperty float nz\n";
  for (const Scalars& scalars : mesh.scalars) out += "property float " + scalars.name + "\n";
  const std::vector<uint8_t> colours =
      mesh.labels.empty() ? std::vector<uint8_t>() : vertex_bytes(mesh);
  if (!colours.empty()) {
    out += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  out += "element face ";
  put_integer(out, mesh.abc.size() / 3);
  out += "\nproperty list uchar uint vertex_indices\nend_header\n";
  for (size_t i = 0; i < mesh.xyz.size(); i += 3) {
    for (size_t k = 0; k < 3; ++k) put_coordinate(out, mesh.xyz[i + k], mesh.doubles);
    for (size_t k = 0; with_normals && k < 3; ++k) put_value(out, mesh.normals[i + k]);
    for (const Scalars& scalars : mesh.scalars) put_value(out, scalars.values[i / 3]);
    for (size_t k = 0; !colours.empty() && k < 3; ++k) put_value(out, colours[i + k]);
    drain(file, out);
  }
  for (size_t i = 0; i < mesh.abc.size(); ++i) {
    if (i % 3 == 0) put_value(out, uint8_t{3});
    put_value(out, mesh.abc[i]);
    drain(file, out);
  }
  drain(file, out, true);
}

}  // namespace plc::tools
