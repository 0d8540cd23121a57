// Walks the pages of a TIFF file: every directory and every strip or tile must be in the file, and
// they must be able to hold the voxels.
#include <algorithm>
#include <fstream>
#include <unordered_set>

#include "tools/file/failure.h"
#include "tools/file/text.h"
#include "tools/volume/volume_io_size.h"

namespace plc::tools {
namespace {

class TiffWalker {
 public:
  explicit TiffWalker(const std::string& path)
      : path_(path), file_(path, std::ios::binary), size_(size_of(path)), left_(size_) {
    char magic[4];
    read(0, magic, sizeof magic);
    big_endian_ = magic[0] == 'M';
    const auto version = load_value<uint16_t>(magic + 2, big_endian_);
    wide_ = version == 43;  // BigTIFF
    is_tiff_ =
        (magic[0] == 'I' || magic[0] == 'M') && magic[1] == magic[0] && (wide_ || version == 42);
  }

  bool is_tiff() const { return is_tiff_; }

  // Of voxels at most, in bytes.
  uint64_t walk() {
    uint64_t at = wide_ ? number<uint64_t>(8) : number<uint32_t>(4);
    std::unordered_set<uint64_t> seen;
    while (at != 0) {
      if (!seen.insert(at).second)
        throw Failure{path_ + ": is damaged (its pages lead in a circle)"};
      at = directory(at);
    }
    return capacity_;
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
    const uint64_t at = plus(field.at, times(index, field.size));
    if (field.size == 2) return number<uint16_t>(at);
    return field.size == 4 ? number<uint32_t>(at) : number<uint64_t>(at);
  }
  // What is read of directories is no more than the file: where they overlap they lead in circles.
  void step(uint64_t size) {
    if (size > left_) throw Failure{path_ + ": is damaged (its pages overlap)"};
    left_ -= size;
  }
  // Bytes of voxels that a byte may stand for: 8 where it is 8 of one bit; the best that packings
  // reach, which for some is no bound but what a blank page comes to.
  static uint64_t ratio_of(uint64_t compression) {
    constexpr uint64_t kNone = 1;
    constexpr uint64_t kLzw = 5;
    constexpr uint64_t kDeflate = 8;
    constexpr uint64_t kOldDeflate = 32946;
    constexpr uint64_t kPackBits = 32773;
    if (compression == kNone) return 8;
    if (compression == kPackBits) return 8 * 64;
    if (compression == kDeflate || compression == kOldDeflate) return 8 * kZlibRatio;
    return compression == kLzw ? 8 * 4096 : 65536;
  }
  // The offset of the next directory.
  uint64_t directory(uint64_t at) {
    constexpr uint16_t kCompression = 259;
    constexpr uint16_t kStripOffsets = 273;
    constexpr uint16_t kStripBytes = 279;
    constexpr uint16_t kTileOffsets = 324;
    constexpr uint16_t kTileBytes = 325;
    const uint64_t entries = wide_ ? number<uint64_t>(at) : number<uint16_t>(at);
    at += wide_ ? 8 : 2;
    const uint64_t entry_size = wide_ ? 20 : 12;
    if (entries > size_ / entry_size) truncated();
    if (entries == 0) throw Failure{path_ + ": is damaged (a page of it is empty)"};
    step(entries * entry_size);
    uint64_t compression = 1;
    Field offsets;
    Field bytes;
    for (uint64_t i = 0; i < entries; ++i, at += entry_size) {
      const auto tag = number<uint16_t>(at);
      if (tag == kCompression) compression = value(field(at), 0);
      if (tag == kStripOffsets || tag == kTileOffsets) offsets = field(at);
      if (tag == kStripBytes || tag == kTileBytes) bytes = field(at);
    }
    check_pieces(offsets, bytes, ratio_of(compression));
    return wide_ ? number<uint64_t>(at) : number<uint32_t>(at);
  }
  void check_pieces(const Field& offsets, const Field& bytes, uint64_t ratio) {
    // One strip may go without its size: to the end of the file.
    const uint64_t pieces = bytes.count == 0 ? std::min<uint64_t>(offsets.count, 1)
                                             : std::min(offsets.count, bytes.count);
    if (pieces > size_) truncated();
    step(pieces);
    for (uint64_t i = 0; i < pieces; ++i) {
      const uint64_t begin = value(offsets, i);
      if (begin > size_) truncated();
      const uint64_t size = bytes.count == 0 ? size_ - begin : value(bytes, i);
      if (size_ - begin < size) truncated();
      // Pieces that share their bytes count once each, up to the size of the file.
      const uint64_t counted = std::min(size, size_ - std::min(size_, packed_));
      packed_ += counted;
      capacity_ = plus(capacity_, times(counted, ratio));
    }
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
  uint64_t size_;
  uint64_t left_;          // of the file, for directories
  uint64_t packed_ = 0;    // bytes of all strips and tiles
  uint64_t capacity_ = 0;  // bytes of voxels they may stand for
  bool is_tiff_ = false, big_endian_ = false, wide_ = false;
};

}  // namespace

// Libraries walk pages that lead in a circle for ever. What is no TIFF file they see themselves.
void check_tiff_pages(const std::string& path) {
  TiffWalker walker(path);
  if (walker.is_tiff()) walker.walk();
}

void check_tiff_size(const std::string& path, const ItkHeader& header) {
  require_bytes(path, TiffWalker(path).walk(), voxel_bytes(header));
}

}  // namespace plc::tools
