// Walks the pages of a TIFF file: every directory and every strip or tile must be in the file.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "tools/mesh_io_text.h"
#include "tools/volume_io_formats.h"

namespace plc::tools {
namespace {

class TiffWalker {
 public:
  explicit TiffWalker(const std::string& path) : path_(path), file_(path, std::ios::binary) {
    std::error_code error;
    size_ = std::filesystem::file_size(path, error);
  }

  void walk() {
    char magic[4];
    read(0, magic, sizeof magic);
    big_endian_ = magic[0] == 'M';
    wide_ = load_value<uint16_t>(magic + 2, big_endian_) == 43;  // BigTIFF
    uint64_t at = wide_ ? number<uint64_t>(8) : number<uint32_t>(4);
    // Directories that lead back to themselves end at the number the file has room for.
    for (uint64_t pages = size_ / 6; at != 0 && pages > 0; --pages) at = directory(at);
  }

 private:
  struct Field {
    uint64_t count = 0;
    uint64_t at = 0;  // of the values
    size_t size = 0;  // of one
  };

  void read(uint64_t at, char* data, size_t size) {
    if (at > size_ || size_ - at < size) truncated();
    file_.seekg(static_cast<std::streamoff>(at));
    if (!file_.read(data, static_cast<std::streamsize>(size))) truncated();
  }
  [[noreturn]] void truncated() const {
    throw Failure{path_ + ": is truncated (some of its pages are not in it)"};
  }
  template <typename T>
  T number(uint64_t at) {
    char bytes[sizeof(T)];
    read(at, bytes, sizeof bytes);
    return load_value<T>(bytes, big_endian_);
  }
  uint64_t value(const Field& field, uint64_t index) {
    const uint64_t at = field.at + index * field.size;
    if (field.size == 2) return number<uint16_t>(at);
    return field.size == 4 ? number<uint32_t>(at) : number<uint64_t>(at);
  }
  // The offset of the next directory.
  uint64_t directory(uint64_t at) {
    constexpr uint16_t kStripOffsets = 273;
    constexpr uint16_t kStripBytes = 279;
    constexpr uint16_t kTileOffsets = 324;
    constexpr uint16_t kTileBytes = 325;
    const uint64_t entries = wide_ ? number<uint64_t>(at) : number<uint16_t>(at);
    at += wide_ ? 8 : 2;
    const uint64_t entry_size = wide_ ? 20 : 12;
    if (entries > size_ / entry_size) truncated();
    Field offsets;
    Field bytes;
    for (uint64_t i = 0; i < entries; ++i, at += entry_size) {
      const auto tag = number<uint16_t>(at);
      if (tag == kStripOffsets || tag == kTileOffsets) offsets = field(at);
      if (tag == kStripBytes || tag == kTileBytes) bytes = field(at);
    }
    const uint64_t pieces = std::min(offsets.count, bytes.count);
    if (pieces > size_) truncated();
    for (uint64_t i = 0; i < pieces; ++i) {
      const uint64_t begin = value(offsets, i);
      if (begin > size_ || size_ - begin < value(bytes, i)) truncated();
    }
    return wide_ ? number<uint64_t>(at) : number<uint32_t>(at);
  }
  Field field(uint64_t entry) {
    Field field;
    const auto type = number<uint16_t>(entry + 2);
    field.size = type == 3 ? 2 : type == 16 ? 8 : 4;  // SHORT, LONG8, LONG
    field.count = wide_ ? number<uint64_t>(entry + 4) : number<uint32_t>(entry + 4);
    const uint64_t place = entry + (wide_ ? 12 : 8);
    const bool is_inside = field.count <= (wide_ ? 8U : 4U) / field.size;
    field.at = is_inside ? place : wide_ ? number<uint64_t>(place) : number<uint32_t>(place);
    return field;
  }

  const std::string& path_;
  std::ifstream file_;
  uint64_t size_ = 0;
  bool big_endian_ = false, wide_ = false;
};

}  // namespace

void check_tiff_size(const std::string& path) {
  TiffWalker(path).walk();
}

}  // namespace plc::tools
