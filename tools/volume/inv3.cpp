#include "tools/volume/inv3.h"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "tools/file/failure.h"
#include "tools/file/printable.h"
#include "tools/file/xml_reader.h"
#include "tools/volume/volume_io_memory.h"

namespace plc::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "matrix.dat is copied as it is");

// A property list as far as it is needed: the text of every scalar under the keys that lead to it,
// joined by '/'; the items of an array are numbered: "matrix/shape/0".
using PropertyList = std::map<std::string, std::string>;

class PlistParser : public XmlVisitor {
 public:
  PropertyList take() { return std::move(values_); }

  void start(const std::string& name, Attributes) override {
    text_.clear();
    if (name == "dict" || name == "array") containers_.push_back({name == "array", "", 0});
  }
  void end(const std::string& name) override {
    if (name == "plist") return;
    if (name == "key") {
      if (!containers_.empty()) containers_.back().key = text_;
      return;
    }
    if (name == "dict" || name == "array") {
      if (!containers_.empty()) containers_.pop_back();
    } else if (const std::string place = this->place(); place.size() <= kLongestPlace) {
      values_[place] = text_;
    }
    if (!containers_.empty() && containers_.back().is_array) ++containers_.back().items;
  }
  void text(std::string_view part) override { text_ += part; }

 private:
  struct Container {
    bool is_array;
    std::string key;  // of the next value
    int items = 0;
  };
  // Of what is asked for. Longer ones are cut off as they are made: many values under long keys
  // would take the square of the file's size.
  static constexpr size_t kLongestPlace = 32;

  std::string place() const {
    std::string path;
    for (const Container& container : containers_) {
      if (!path.empty()) path += '/';
      path += container.is_array ? std::to_string(container.items)
                                 : container.key.substr(0, kLongestPlace + 1);
      if (path.size() > kLongestPlace) break;
    }
    return path;
  }

  std::vector<Container> containers_;
  std::string text_;
  PropertyList values_;
};

class Archive {
 public:
  explicit Archive(const std::string& path) : path_(path), archive_(archive_read_new()) {
    if (archive_ == nullptr) throw Failure{path + ": not enough memory"};
    archive_read_support_filter_gzip(archive_);
    archive_read_support_format_tar(archive_);
    constexpr size_t kBlock = size_t{1} << 16;
    if (archive_read_open_filename(archive_, path.c_str(), kBlock) != ARCHIVE_OK) {
      const std::string message = error();
      archive_read_free(archive_);
      throw Failure{path + ": is not an InVesalius project" + message};
    }
  }
  ~Archive() { archive_read_free(archive_); }
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;

  // Moves to the entry whose name without folders is `name`; its size, or nothing.
  std::optional<int64_t> find(const std::string& name) {
    archive_entry* entry = nullptr;
    int status = ARCHIVE_OK;
    while ((status = archive_read_next_header(archive_, &entry)) == ARCHIVE_OK) {
      const char* full = archive_entry_pathname(entry);
      if (full == nullptr || archive_entry_filetype(entry) != AE_IFREG) continue;
      const char* slash = std::strrchr(full, '/');
      if (name != (slash != nullptr ? slash + 1 : full)) continue;
      check_packing();
      return std::max<int64_t>(archive_entry_size(entry), 0);
    }
    if (status != ARCHIVE_EOF) throw Failure{path_ + ": is damaged or truncated" + error()};
    return std::nullopt;
  }
  // Whether an entry of `size` bytes may be in the archive. What may not is not worth memory: a
  // header says any size, and a sparse entry has it.
  bool can_hold(int64_t size) const {
    constexpr int64_t kMaxRatio = 1040;  // zlib's is 1032
    const auto file = static_cast<int64_t>(std::filesystem::file_size(path_));
    return size / (is_packed() ? kMaxRatio : 1) <= file;
  }
  void read(const std::string& name, void* data, size_t size) {
    auto* bytes = static_cast<char*>(data);
    while (size > 0) {
      const la_ssize_t got = archive_read_data(archive_, bytes, size);
      if (got <= 0) {
        throw Failure{path_ + ": " + printable(name) + " in it is truncated" + error()};
      }
      bytes += got;
      size -= static_cast<size_t>(got);
    }
  }

 private:
  std::string error() const {
    const char* text = archive_error_string(archive_);
    return text != nullptr ? " (" + printable(text) + ")" : std::string();
  }
  // The last filter is the file itself.
  bool is_packed() const { return archive_filter_count(archive_) > 1; }
  // Each packing multiplies what the one in it has multiplied.
  void check_packing() const {
    if (archive_filter_count(archive_) > 2) throw Failure{path_ + ": is packed more than once"};
  }
  std::string path_;
  archive* archive_;
};

struct Matrix {
  plc_voxel_type type = PLC_I16;
  int64_t dims[3] = {0, 0, 0};
  double spacing[3] = {0, 0, 0};
  std::string file;
};

template <typename Number>
Number number(const std::string& path, const PropertyList& list, const std::string& key) {
  const auto found = list.find(key);
  if (found == list.end()) throw Failure{path + ": main.plist does not have " + key};
  const std::string& text = found->second;
  Number value{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    throw Failure{path + ": in main.plist, " + key + " is \"" + printable(text) +
                  "\", not a number"};
  }
  return value;
}

Matrix parse_matrix(const std::string& path, const std::string& text) {
  static const std::map<std::string, plc_voxel_type> types = {{"uint8", PLC_U8},
                                                              {"int16", PLC_I16},
                                                              {"uint16", PLC_U16},
                                                              {"int32", PLC_I32},
                                                              {"float32", PLC_F32}};
  PlistParser parser;
  read_xml(path + ": main.plist", text, true, parser);
  const PropertyList list = parser.take();
  Matrix matrix;
  const auto type = list.find("matrix/dtype");
  if (type == list.end()) throw Failure{path + ": main.plist does not have matrix/dtype"};
  const auto known = types.find(type->second);
  if (known == types.end()) {
    throw Failure{path + ": voxels of type " + printable(type->second) + " are not supported"};
  }
  matrix.type = known->second;
  for (int axis = 0; axis < 3; ++axis) {
    const std::string item = std::to_string(2 - axis);
    matrix.dims[axis] = number<int64_t>(path, list, "matrix/shape/" + item);
    matrix.spacing[axis] = number<double>(path, list, "spacing/" + std::to_string(axis));
    if (!(matrix.spacing[axis] > 0) || !std::isfinite(matrix.spacing[axis])) {
      throw Failure{path + ": its voxel spacing is not usable"};
    }
  }
  const auto file = list.find("matrix/filename");
  matrix.file = file != list.end() ? file->second : "matrix.dat";
  return matrix;
}

}  // namespace

LoadedVolume read_inv3(const std::string& path) {
  constexpr int64_t kMaxPlist = int64_t{1} << 22;  // a real one has some kilobytes
  std::string plist;
  {
    Archive archive(path);
    const std::optional<int64_t> size = archive.find("main.plist");
    if (!size) throw Failure{path + ": is not an InVesalius project (no main.plist in it)"};
    if (*size > kMaxPlist) throw Failure{path + ": main.plist in it is too large"};
    plist.resize(static_cast<size_t>(*size));
    archive.read("main.plist", plist.data(), plist.size());
  }
  const Matrix matrix = parse_matrix(path, plist);
  const auto needed =
      static_cast<int64_t>(voxel_size(matrix.type)) * checked_voxel_count(path, matrix.dims);
  Archive archive(path);  // from its start: the order of the entries is free
  const std::optional<int64_t> size = archive.find(matrix.file);
  const std::string name = printable(matrix.file);
  if (!size) throw Failure{path + ": has no " + name + " in it"};
  if (*size != needed) {
    throw Failure{path + ": " + name + " in it has " + std::to_string(*size) + " bytes, " +
                  dims_text(matrix.dims) + " voxels need " + std::to_string(needed)};
  }
  if (!archive.can_hold(needed)) {
    throw Failure{path + ": is too small to hold the " + std::to_string(needed) + " bytes of " +
                  name};
  }
  LoadedVolume volume = make_volume(path, matrix.type, matrix.dims);
  archive.read(matrix.file, volume.bytes.data(), volume.bytes.size());
  for (int axis = 0; axis < 3; ++axis) volume.image.spacing[axis] = matrix.spacing[axis];
  volume.image.direction[4] = -1;
  return volume;
}

}  // namespace plc::tools
