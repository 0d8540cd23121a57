// GIFTI, surfaces of neuroimaging (.gii, by custom .surf.gii): written compressed, read in every
// encoding but files beside the file. Coordinates are in RAS by the standard, those of voxels
// excepted, which only we write and name.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include "tools/file/base64.h"
#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"
#include "tools/file/memory.h"
#include "tools/file/printable.h"
#include "tools/file/text.h"
#include "tools/file/xml_reader.h"
#include "tools/mesh/mesh_io_formats.h"

namespace plc::tools {
namespace {

constexpr const char* kPoints = "NIFTI_INTENT_POINTSET";
constexpr const char* kTriangles = "NIFTI_INTENT_TRIANGLE";
constexpr const char* kValues = "NIFTI_INTENT_SHAPE";
constexpr const char* kLabelIntent = "NIFTI_INTENT_LABEL";

// From LPS to RAS and back.
void turn_round(std::vector<double>& xyz) {
  for (size_t i = 0; i < xyz.size(); ++i) {
    if (i % 3 != 2) xyz[i] = -xyz[i];
  }
}

// ---- reading --------------------------------------------------------------------------------

struct GiftiArray {
  std::string intent, type, encoding, name, text;
  bool big_endian = false;
  bool columns_first = false;  // as in Fortran
  uint64_t rows = 0, columns = 1;
};

uint64_t to_size(const std::string& text) {
  return std::strtoull(text.c_str(), nullptr, 10);
}

class GiftiParser : public XmlVisitor {
 public:
  explicit GiftiParser(const std::string& path) : path_(path) {}

  const std::vector<GiftiArray>& arrays() const { return arrays_; }
  const std::string& space() const { return space_; }
  bool is_gifti() const { return is_gifti_; }

  void start(const std::string& name, Attributes attributes) override {
    element_ = name;
    text_.clear();
    if (name == "GIFTI") is_gifti_ = true;
    if (name != "DataArray") return;
    if (arrays_.size() == kMostArrays) throw Failure{path_ + ": has too many arrays"};
    GiftiArray& array = arrays_.emplace_back();
    array.intent = xml_attribute(attributes, "Intent");
    array.type = xml_attribute(attributes, "DataType");
    array.encoding = xml_attribute(attributes, "Encoding");
    array.big_endian = xml_attribute(attributes, "Endian") == "BigEndian";
    array.columns_first = xml_attribute(attributes, "ArrayIndexingOrder") == "ColumnMajorOrder";
    array.rows = to_size(xml_attribute(attributes, "Dim0"));
    const std::string columns = xml_attribute(attributes, "Dim1");
    if (!columns.empty()) array.columns = to_size(columns);
  }
  void end(const std::string& name) override {
    if (name == "Name") key_ = text_;
    if (name == "Value" && key_ == "SPACE") space_ = space_in("SPACE=" + text_);
    if (name == "Value" && key_ == "Name" && !arrays_.empty()) arrays_.back().name = text_;
    element_.clear();
  }
  void text(std::string_view part) override {
    if (element_ == "Data") {
      if (!arrays_.empty()) arrays_.back().text += part;
    } else if (element_ == "Name" || element_ == "Value") {
      text_ += part;
    }
  }

 private:
  static constexpr size_t kMostArrays = 256;

  const std::string& path_;
  std::vector<GiftiArray> arrays_;
  std::string element_, text_, key_, space_;
  bool is_gifti_ = false;
};

class ArrayValues {
 public:
  ArrayValues(const std::string& path, const GiftiArray& array) : path_(path), array_(array) {}

  // Row by row.
  std::vector<double> read() const {
    if (array_.columns != 1 && array_.columns != 3) fail("has neither one column nor three");
    std::vector<double> values = array_.encoding == "ASCII" ? of_text() : of_bytes();
    if (!array_.columns_first || array_.columns == 1) return values;
    std::vector<double> turned(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
      turned[i % array_.rows * array_.columns + i / array_.rows] = values[i];
    }
    return turned;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Failure{path_ + ": its array " + printable(array_.intent) + " " + message};
  }
  uint64_t count() const { return times(array_.rows, array_.columns); }

  std::vector<double> of_text() const {
    if (count() > array_.text.size() / 2 + 1) fail("is truncated");
    std::vector<double> values;
    TextReader text(path_, array_.text);
    while (values.size() < count()) values.push_back(text.real());
    return values;
  }

  size_t value_size() const {
    struct Type {
      std::string_view name;
      size_t size;
    };
    static constexpr Type kTypes[] = {{"NIFTI_TYPE_FLOAT32", 4},
                                      {"NIFTI_TYPE_INT32", 4},
                                      {"NIFTI_TYPE_UINT8", 1},
                                      {"NIFTI_TYPE_FLOAT64", 8}};
    for (const Type& type : kTypes) {
      if (type.name == array_.type) return type.size;
    }
    fail("has an unknown type");
  }

  std::vector<double> of_bytes() const {
    const bool packed = array_.encoding == "GZipBase64Binary";
    if (!packed && array_.encoding != "Base64Binary") fail("has an encoding that is not read");
    constexpr uint64_t kMaxRatio = 1100;  // zlib's is 1032
    const uint64_t bytes = times(count(), value_size());
    if (bytes > times(array_.text.size(), packed ? kMaxRatio : 1)) fail("is truncated");
    require_memory(path_, plus(bytes, times(count(), sizeof(double))));
    std::string data = decode_base64(array_.text, packed ? array_.text.size() : bytes);
    if (packed) data = unpacked(data, bytes);
    if (data.size() != bytes) fail("is truncated");
    std::vector<double> values(count());
    for (size_t i = 0; i < values.size(); ++i) values[i] = value_at(data.data(), i);
    return values;
  }

  std::string unpacked(const std::string& data, uint64_t bytes) const {
    std::string out(bytes, '\0');
    uLongf size = bytes;
    if (uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                   reinterpret_cast<const Bytef*>(data.data()), data.size()) != Z_OK ||
        size != bytes) {
      fail("cannot be decompressed");
    }
    return out;
  }

  double value_at(const char* data, size_t i) const {
    const bool big = array_.big_endian;
    if (array_.type == "NIFTI_TYPE_FLOAT32") {
      return static_cast<double>(load_value<float>(data + 4 * i, big));
    }
    if (array_.type == "NIFTI_TYPE_INT32") return load_value<int32_t>(data + 4 * i, big);
    if (array_.type == "NIFTI_TYPE_UINT8") return load_value<uint8_t>(data + i, big);
    return load_value<double>(data + 8 * i, big);
  }

  const std::string& path_;
  const GiftiArray& array_;
};

void read_triangles(const std::string& path, const std::vector<double>& corners,
                    MeshBuilder& mesh) {
  constexpr double kLimit = 4294967296.0;
  for (size_t i = 0; i + 2 < corners.size(); i += 3) {
    int64_t abc[3];
    for (size_t k = 0; k < 3; ++k) {
      const double v = corners[i + k];
      if (!(v >= 0 && v < kLimit) || v != std::floor(v)) {
        throw Failure{path + ": face " + std::to_string(i / 3) + " refers to no vertex"};
      }
      abc[k] = static_cast<int64_t>(v);
    }
    mesh.triangle(abc[0], abc[1], abc[2]);
  }
}

// ---- writing --------------------------------------------------------------------------------

std::string packed_base64(const std::string& path, const std::string& data) {
  uLongf size = compressBound(data.size());
  std::string packed(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(data.data()), data.size(), Z_BEST_SPEED) != Z_OK) {
    throw Failure{path + ": an array cannot be compressed"};
  }
  packed.resize(size);
  return encode_base64(packed);
}

std::string metadata(const std::string& name, const std::string& value) {
  return "<MD><Name><![CDATA[" + name + "]]></Name><Value><![CDATA[" + value + "]]></Value></MD>\n";
}

// Names may hold the end of a CDATA section.
std::string cdata(const std::string& text) {
  std::string out = "<![CDATA[";
  for (size_t i = 0; i < text.size(); ++i) {
    if (text.compare(i, 3, "]]>") == 0) {
      out += "]]]]><![CDATA[>";
      i += 2;
    } else {
      out += text[i];
    }
  }
  return out + "]]>";
}

std::string label_table(const std::vector<LabelInfo>& labels) {
  if (labels.empty()) return "<LabelTable/>\n";
  std::string out = "<LabelTable>\n";
  for (const LabelInfo& label : labels) {
    out += "<Label Key=\"" + std::to_string(label.value) + "\"";
    constexpr std::array<const char*, 3> kParts = {"Red", "Green", "Blue"};
    for (size_t k = 0; k < 3; ++k) {
      out += std::string(" ") + kParts[k] + "=\"";
      put_real(out, label.rgb[k] / 255.0);
      out += '"';
    }
    out += " Alpha=\"1\">" + cdata(label.name) + "</Label>\n";
  }
  return out + "</LabelTable>\n";
}

void write_array(AtomicFile& file, const std::string& intent, const std::string& type, size_t rows,
                 int columns, const std::string& about, const std::string& data) {
  std::string out = "<DataArray Intent=\"" + intent + "\" DataType=\"" + type +
                    "\" ArrayIndexingOrder=\"RowMajorOrder\" Dimensionality=\"" +
                    (columns == 1 ? "1" : "2") + "\" Dim0=\"" + std::to_string(rows) + "\" ";
  if (columns > 1) out += "Dim1=\"" + std::to_string(columns) + "\" ";
  out +=
      "Encoding=\"GZipBase64Binary\" Endian=\"LittleEndian\" ExternalFileName=\"\" "
      "ExternalFileOffset=\"\">\n" +
      about + "<Data>";
  out += packed_base64(intent, data) + "</Data>\n</DataArray>\n";
  drain(file, out, true);
}

}  // namespace

TriangleMesh read_gifti(const std::string& path, std::string_view data) {
  GiftiParser file(path);
  read_xml(path, data, true, file);
  if (!file.is_gifti()) throw Failure{path + ": is not a GIFTI file"};
  MeshBuilder mesh(path);
  bool has_points = false;
  bool has_triangles = false;
  for (const GiftiArray& array : file.arrays()) {
    if (array.intent == kPoints && !has_points) {
      std::vector<double> xyz = ArrayValues(path, array).read();
      if (array.columns != 3) throw Failure{path + ": its points are not triples"};
      if (file.space() != space_names::kVoxel) turn_round(xyz);
      for (size_t i = 0; i < xyz.size(); i += 3) mesh.vertex(xyz[i], xyz[i + 1], xyz[i + 2]);
      has_points = true;
    } else if (array.intent == kTriangles && !has_triangles) {
      if (array.columns != 3) throw Failure{path + ": its faces are no triangles"};
      read_triangles(path, ArrayValues(path, array).read(), mesh);
      has_triangles = true;
    } else if (array.columns == 1 && is_scalar_name(array.name)) {
      const std::vector<double> wide = ArrayValues(path, array).read();
      std::vector<float> narrow(wide.size());
      std::transform(wide.begin(), wide.end(), narrow.begin(),
                     [](double x) { return static_cast<float>(x); });
      mesh.scalars(array.name, std::move(narrow));
    }
  }
  if (!has_points || !has_triangles) throw Failure{path + ": holds no surface"};
  const bool voxels = file.space() == space_names::kVoxel;
  mesh.space(voxels ? space_names::kVoxel : space_names::kLps);
  return mesh.finish();
}

void write_gifti(AtomicFile& file, const TriangleMesh& mesh) {
  const size_t vertices = mesh.xyz.size() / 3;
  const bool voxels = mesh.space == space_names::kVoxel;
  std::vector<double> xyz = mesh.xyz;
  if (!voxels && mesh.space != space_names::kRas) turn_round(xyz);
  file.write(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<!DOCTYPE GIFTI SYSTEM \"http://www.nitrc.org/frs/download.php/115/gifti.dtd\">\n"
      "<GIFTI Version=\"1.0\" NumberOfDataArrays=\"" +
      std::to_string(2 + mesh.scalars.size()) + "\">\n<MetaData>\n" +
      metadata("SPACE", voxels ? space_names::kVoxel : space_names::kRas) + "</MetaData>\n" +
      label_table(mesh.labels));
  std::string data;
  for (const double x : xyz) put_value(data, static_cast<float>(x));
  const std::string frame = voxels ? "NIFTI_XFORM_UNKNOWN" : "NIFTI_XFORM_SCANNER_ANAT";
  write_array(file, kPoints, "NIFTI_TYPE_FLOAT32", vertices, 3,
              "<MetaData/>\n<CoordinateSystemTransformMatrix>\n<DataSpace><![CDATA[" + frame +
                  "]]></DataSpace>\n<TransformedSpace><![CDATA[" + frame +
                  "]]></TransformedSpace>\n<MatrixData>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"
                  "</MatrixData>\n</CoordinateSystemTransformMatrix>\n",
              data);
  if (vertices > static_cast<size_t>(std::numeric_limits<int32_t>::max())) {
    throw Failure{"a GIFTI file cannot hold " + std::to_string(vertices) + " vertices"};
  }
  data.clear();
  for (const uint32_t v : mesh.abc) put_value(data, static_cast<int32_t>(v));
  write_array(file, kTriangles, "NIFTI_TYPE_INT32", mesh.abc.size() / 3, 3, "<MetaData/>\n", data);
  for (const Scalars& scalars : mesh.scalars) {
    data.clear();
    const bool labels = scalars.are_labels();
    for (const float value : scalars.values) {
      if (labels) {
        put_value(data, std::isfinite(value) ? static_cast<int32_t>(value) : 0);
      } else {
        put_value(data, value);
      }
    }
    write_array(file, labels ? kLabelIntent : kValues,
                labels ? "NIFTI_TYPE_INT32" : "NIFTI_TYPE_FLOAT32", vertices, 1,
                "<MetaData>\n" + metadata("Name", scalars.name) + "</MetaData>\n", data);
  }
  file.write("</GIFTI>\n");
}

}  // namespace plc::tools
