// VTK's XML PolyData: written with raw appended arrays; read in every encoding but LZ4 and LZMA.
#include <algorithm>
#include <cstdlib>
#include <vector>

#include "tools/file/failure.h"
#include "tools/file/text.h"
#include "tools/file/xml_reader.h"
#include "tools/mesh/mesh_io_formats.h"
#include "tools/mesh/mesh_io_vtp_array.h"
#include "tools/mesh/vertex_colours.h"

namespace plc::tools {
namespace {

struct CellArrays {
  VtpArray connectivity, offsets;
};

struct Piece {
  VtpArray points, normals;
  std::vector<VtpArray> scalars;
  CellArrays polygons, strips;
};

// Finds the arrays of a file. Only what is before the appended data is XML: raw data would not be.
class VtpParser : public XmlVisitor {
 public:
  VtpParser(const std::string& path, std::string_view data) : path_(path) {
    const size_t tag = data.find("<AppendedData");
    const size_t close = tag != std::string_view::npos ? data.find('>', tag) : tag;
    const bool has_appended = close != std::string_view::npos;
    if (has_appended) {
      const size_t underscore = data.find('_', close);
      if (underscore == std::string_view::npos) throw Failure{path + ": has no appended data"};
      appended_.data = data.substr(underscore + 1);
    }
    read_xml(path, has_appended ? data.substr(0, close + 1) : data, !has_appended, *this);
    if (unknown_compressor_) throw Failure{path + ": is compressed by other means than zlib"};
    if (!is_poly_data_) throw Failure{path + ": is not a PolyData file of VTK"};
  }

  const std::vector<Piece>& pieces() const { return pieces_; }
  const VtpEncoding& encoding() const { return encoding_; }
  const VtpAppended& appended() const { return appended_; }
  // As its field "SPACE" has it: the characters, as numbers, and a zero.
  std::string space() const {
    std::string name;
    TextReader text(path_, space_.text);
    while (name.size() < kLongestSpace && !text.at_end()) {
      const double c = text.real();
      if (c > ' ' && c <= '~') name += static_cast<char>(c);
    }
    return space_in("SPACE=" + name);
  }

  void start(const std::string& name, Attributes attributes) override {
    array_ = nullptr;  // of a piece that the next one may move
    if (name == "VTKFile") {
      is_poly_data_ = xml_attribute(attributes, "type") == "PolyData";
      encoding_.big_endian = xml_attribute(attributes, "byte_order") == "BigEndian";
      encoding_.wide_header = xml_attribute(attributes, "header_type") == "UInt64";
      const std::string compressor = xml_attribute(attributes, "compressor");
      encoding_.compressed = !compressor.empty();
      unknown_compressor_ = encoding_.compressed && compressor != "vtkZLibDataCompressor";
    } else if (name == "Piece") {
      if (pieces_.size() == kMostPieces) throw Failure{path_ + ": has too many pieces"};
      pieces_.emplace_back();
    } else if (name == "AppendedData") {
      appended_.base64 = xml_attribute(attributes, "encoding") == "base64";
    } else if (name == "DataArray") {
      start_array(attributes);
    } else {
      section_ = name;
      if (name == "PointData") normals_name_ = xml_attribute(attributes, "Normals");
    }
  }
  void end(const std::string& name) override {
    array_ = nullptr;
    if (name == section_) section_.clear();
  }
  void text(std::string_view part) override {
    if (array_ != nullptr) array_->text += part;
  }

 private:
  void start_array(Attributes attributes) {
    const std::string name = xml_attribute(attributes, "Name");
    const bool is_space = section_ == "FieldData" && name == "SPACE" &&
                          xml_attribute(attributes, "format") == "ascii" && space_.text.empty();
    const bool is_number = is_vtp_number(xml_attribute(attributes, "type"));
    array_ = is_space          ? &space_
             : pieces_.empty() ? nullptr
                               : wanted(pieces_.back(), name, is_number);
    if (array_ == nullptr) return;
    *array_ = {name, xml_attribute(attributes, "type"), xml_attribute(attributes, "format"), 1, {},
               0};
    const std::string components = xml_attribute(attributes, "NumberOfComponents");
    if (components == "3") array_->components = 3;
    array_->offset = std::strtoull(xml_attribute(attributes, "offset").c_str(), nullptr, 10);
  }
  // Where the array is to go; null: nowhere.
  VtpArray* wanted(Piece& piece, const std::string& name, bool is_number) const {
    if (section_ == "Points") return &piece.points;
    if (section_ == "PointData" && !name.empty() && name == normals_name_) return &piece.normals;
    if (section_ == "PointData") {
      if (!is_scalar_name(name) || !is_number || piece.scalars.size() >= kMostScalars) {
        return nullptr;
      }
      return &piece.scalars.emplace_back();
    }
    CellArrays* cells = section_ == "Polys"    ? &piece.polygons
                        : section_ == "Strips" ? &piece.strips
                                               : nullptr;
    if (cells == nullptr) return nullptr;
    if (name == "connectivity") return &cells->connectivity;
    return name == "offsets" ? &cells->offsets : nullptr;
  }

  static constexpr size_t kMostPieces = 65536;  // each takes a hundred times its tag
  static constexpr size_t kMostScalars = 64;
  static constexpr size_t kLongestSpace = 16;

  const std::string& path_;
  VtpEncoding encoding_;
  VtpAppended appended_;
  std::vector<Piece> pieces_;
  std::string section_, normals_name_;
  VtpArray space_;
  VtpArray* array_ = nullptr;  // the one being read
  bool is_poly_data_ = false, unknown_compressor_ = false;
};

class VtpReader {
 public:
  VtpReader(const std::string& path, std::string_view data)
      : path_(path), file_(path, data), left_(data.size()), mesh_(path) {}

  TriangleMesh read() {
    for (const Piece& piece : file_.pieces()) {
      const auto base = static_cast<int64_t>(mesh_.vertex_count());
      const std::vector<double> xyz = values(piece.points);
      if (xyz.size() % 3 != 0) throw Failure{path_ + ": its points are not triples"};
      for (size_t i = 0; i < xyz.size(); i += 3) mesh_.vertex(xyz[i], xyz[i + 1], xyz[i + 2]);
      const std::vector<double> normals = values(piece.normals);
      for (size_t i = 0; normals.size() == xyz.size() && i < normals.size(); i += 3) {
        mesh_.normal(normals[i], normals[i + 1], normals[i + 2]);
      }
      const int64_t end = base + static_cast<int64_t>(xyz.size() / 3);
      for_each_cell(piece.polygons, base, end,
                    [&](const std::vector<int64_t>& corners) { mesh_.polygon(corners); });
      for_each_cell(piece.strips, base, end, [&](const std::vector<int64_t>& corners) {
        for (size_t i = 2; i < corners.size(); ++i) {  // every second triangle is turned over
          mesh_.triangle(corners[i - 2], corners[i - 1 + i % 2], corners[i - i % 2]);
        }
      });
    }
    if (file_.pieces().size() == 1) read_scalars(file_.pieces()[0]);
    mesh_.space(file_.space());
    return mesh_.finish();
  }

 private:
  void read_scalars(const Piece& piece) {
    for (const VtpArray& array : piece.scalars) {
      if (array.components != 1) continue;
      const std::vector<double> wide = values(array);
      std::vector<float> narrow(wide.size());
      std::transform(wide.begin(), wide.end(), narrow.begin(),
                     [](double x) { return static_cast<float>(x); });
      mesh_.scalars(array.name, std::move(narrow));
    }
  }
  std::vector<double> values(const VtpArray& array) {
    if (array.format.empty()) return {};
    return vtp_values(path_, file_.encoding(), file_.appended(), array, left_);
  }
  template <typename Visit>
  void for_each_cell(const CellArrays& cells, int64_t base, int64_t end, const Visit& visit) {
    const std::vector<double> connectivity = values(cells.connectivity);
    std::vector<int64_t> corners;
    size_t begin = 0;
    for (const double offset : values(cells.offsets)) {
      if (!(offset >= static_cast<double>(begin) &&
            offset <= static_cast<double>(connectivity.size()))) {
        throw Failure{path_ + ": the offsets of its cells do not fit their corners"};
      }
      const auto stop = static_cast<size_t>(offset);
      corners.clear();
      for (size_t i = begin; i < stop; ++i) {
        if (!(connectivity[i] >= 0 && connectivity[i] < static_cast<double>(end - base))) {
          throw Failure{path_ + ": a cell refers to a point that is not there"};
        }
        corners.push_back(base + static_cast<int64_t>(connectivity[i]));
      }
      visit(corners);
      begin = stop;
    }
  }

  const std::string& path_;
  VtpParser file_;
  uint64_t left_;  // see vtp_values()
  MeshBuilder mesh_;
};

std::string array_tag(const char* type, const std::string& name, int components, size_t offset) {
  std::string text = std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\"";
  if (components > 1) text += " NumberOfComponents=\"" + std::to_string(components) + "\"";
  return text + " format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
}

// The field by which 3D Slicer knows it.
// VTK writes text as the numbers of its bytes, with a zero behind each string.
std::string text_array(const char* name, const std::vector<std::string>& strings) {
  std::string text = std::string("<DataArray type=\"String\" Name=\"") + name +
                     "\" NumberOfTuples=\"" + std::to_string(strings.size()) +
                     "\" format=\"ascii\">";
  for (const std::string& string : strings) {
    for (const char c : string) text += std::to_string(static_cast<unsigned char>(c)) + " ";
    text += "0 ";
  }
  text.back() = '<';
  return text + "/DataArray>\n";
}

// What the mesh as a whole has: its space, and the names of labels beside their values.
std::string field_data(const TriangleMesh& mesh) {
  std::string text;
  if (!mesh.space.empty()) text += text_array("SPACE", {mesh.space});
  if (!mesh.labels.empty()) {
    std::vector<std::string> names;
    text += "<DataArray type=\"Int32\" Name=\"LabelValues\" NumberOfTuples=\"" +
            std::to_string(mesh.labels.size()) + "\" format=\"ascii\">";
    for (const LabelInfo& label : mesh.labels) {
      text += std::to_string(label.value) + " ";
      names.push_back(label.name);
    }
    text += "</DataArray>\n" + text_array("LabelNames", names);
  }
  return text.empty() ? "" : "<FieldData>\n" + text + "</FieldData>\n";
}

template <typename To, typename Values>
void write_array(AtomicFile& file, const Values& values) {
  std::string out;
  put_value(out, uint64_t{values.size() * sizeof(To)});
  for (const auto value : values) {
    put_value(out, static_cast<To>(value));
    drain(file, out);
  }
  drain(file, out, true);
}

}  // namespace

TriangleMesh read_vtp(const std::string& path, std::string_view data) {
  return VtpReader(path, data).read();
}

void write_vtp(AtomicFile& file, const TriangleMesh& mesh) {
  const bool with_normals = mesh.normals.size() == mesh.xyz.size();
  const size_t faces = mesh.abc.size() / 3;
  const size_t points_bytes =
      sizeof(uint64_t) + mesh.xyz.size() * (mesh.doubles ? sizeof(double) : sizeof(float));
  const size_t normals_bytes = sizeof(uint64_t) + mesh.xyz.size() * sizeof(float);
  const size_t scalars_at = points_bytes + (with_normals ? normals_bytes : 0);
  const size_t scalar_bytes = sizeof(uint64_t) + mesh.xyz.size() / 3 * sizeof(float);
  const size_t colours_at = scalars_at + scalar_bytes * mesh.scalars.size();
  const std::vector<uint8_t> colours =
      mesh.labels.empty() ? std::vector<uint8_t>() : vertex_bytes(mesh);
  const size_t cells_at = colours_at + (colours.empty() ? 0 : sizeof(uint64_t) + colours.size());
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
      "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n";
  out += field_data(mesh) + "<Piece NumberOfPoints=\"";
  put_integer(out, mesh.xyz.size() / 3);
  out += "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"";
  put_integer(out, faces);
  out += "\">\n";
  if (with_normals || !mesh.scalars.empty()) {
    out += with_normals ? "<PointData Normals=\"Normals\">\n" : "<PointData>\n";
    if (with_normals) out += array_tag("Float32", "Normals", 3, points_bytes);
    for (size_t i = 0; i < mesh.scalars.size(); ++i) {
      out += array_tag("Float32", mesh.scalars[i].name, 1, scalars_at + i * scalar_bytes);
    }
    if (!colours.empty()) out += array_tag("UInt8", "Colours", 3, colours_at);
    out += "</PointData>\n";
  }
  out += "<Points>\n" + array_tag(mesh.doubles ? "Float64" : "Float32", "Points", 3, 0) +
         "</Points>\n<Polys>\n";
  out += array_tag("Int64", "connectivity", 1, cells_at);
  out += array_tag("Int64", "offsets", 1,
                   cells_at + sizeof(uint64_t) + mesh.abc.size() * sizeof(int64_t));
  out += "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  drain(file, out, true);
  if (mesh.doubles) {
    write_array<double>(file, mesh.xyz);
  } else {
    write_array<float>(file, mesh.xyz);
  }
  if (with_normals) write_array<float>(file, mesh.normals);
  for (const Scalars& scalars : mesh.scalars) write_array<float>(file, scalars.values);
  if (!colours.empty()) write_array<uint8_t>(file, colours);
  write_array<int64_t>(file, mesh.abc);
  std::vector<int64_t> offsets(faces);
  for (size_t i = 0; i < faces; ++i) offsets[i] = static_cast<int64_t>(3 * (i + 1));
  write_array<int64_t>(file, offsets);
  file.write("\n</AppendedData>\n</VTKFile>\n");
}

}  // namespace plc::tools
