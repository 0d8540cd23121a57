#include "tools/mesh/mesh_io_vtp_array.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>

#include "tools/file/base64.h"
#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"
#include "tools/file/memory.h"
#include "tools/file/printable.h"
#include "tools/file/text.h"

namespace plc::tools {
namespace {

class ArrayReader {
 public:
  ArrayReader(const std::string& path, const VtpEncoding& encoding, const VtpAppended& appended,
              const VtpArray& array, uint64_t& left)
      : path_(path), encoding_(encoding), array_(array), left_(left) {
    if (array.format != "appended") {
      source_ = array.text;
      base64_ = true;
      return;
    }
    if (array.offset > appended.data.size()) fail("begins beyond the end of the file");
    source_ = appended.data.substr(array.offset);
    base64_ = appended.base64;
  }

  // value_size: of the values that are to be made doubles of.
  std::string bytes(size_t value_size) {
    return encoding_.compressed ? decompressed(value_size) : plain();
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw Failure{path_ + ": its array " + printable(array_.name) + " " + message};
  }

 private:
  size_t word_size() const { return encoding_.wide_header ? 8 : 4; }

  // The first `size` bytes, decoded.
  std::string first(uint64_t size) const {
    std::string data =
        base64_ ? decode_base64(source_, size)
                : std::string(source_.substr(0, std::min<uint64_t>(size, source_.size())));
    if (data.size() < size) fail("is truncated");
    return data;
  }
  uint64_t word(const std::string& data, size_t index) const {
    const char* at = data.data() + index * word_size();
    return encoding_.wide_header ? load_value<uint64_t>(at, encoding_.big_endian)
                                 : load_value<uint32_t>(at, encoding_.big_endian);
  }
  // Nothing is longer than what it is read from.
  void check_length(uint64_t length) const {
    if (length > source_.size()) fail("is truncated");
  }

  void take(uint64_t size) {
    if (size > left_) fail("is made of bytes of other arrays");
    left_ -= size;
  }

  void check_ratio(uint64_t blocks, uint64_t size, uint64_t last_size, uint64_t packed) const {
    constexpr uint64_t kMaxRatio = 1100;  // zlib's is 1032
    if (last_size > size || times(size, blocks) > times(packed, kMaxRatio)) {
      fail("has lengths that contradict each other");
    }
  }

  std::string plain() {
    const uint64_t length = word(first(word_size()), 0);
    check_length(length);
    take(length);
    return first(plus(word_size(), length)).substr(word_size());
  }

  // Header: blocks, bytes of a block, bytes of the last one (0: a whole one), then the compressed
  // bytes of each block; then the blocks.
  std::string decompressed(size_t value_size) {
    const uint64_t blocks = word(first(word_size()), 0);
    if (blocks == 0) return {};
    check_length(blocks);
    const std::string sizes = first(3 * word_size());
    const uint64_t block_size = word(sizes, 1);
    const uint64_t last_size = word(sizes, 2) != 0 ? word(sizes, 2) : block_size;
    check_ratio(blocks, block_size, last_size, source_.size());
    const uint64_t header_size = times(plus(blocks, 3), word_size());
    const std::string header = first(header_size);
    uint64_t packed = 0;
    for (uint64_t i = 0; i < blocks; ++i) {
      check_length(word(header, 3 + i));
      packed += word(header, 3 + i);
      check_length(packed);
    }
    check_ratio(blocks, block_size, last_size, packed);
    const std::string data = first(plus(header_size, packed));
    take(plus(header_size, packed));
    const uint64_t total = (blocks - 1) * block_size + last_size;
    require_memory(path_, plus(total, times(total / value_size, sizeof(double))));
    std::string out(total, '\0');
    const char* in = data.data() + header_size;
    for (uint64_t i = 0; i < blocks; ++i) {
      const uint64_t wanted = i + 1 < blocks ? block_size : last_size;
      uLongf size = wanted;
      const uint64_t length = word(header, 3 + i);
      if (uncompress(reinterpret_cast<Bytef*>(out.data() + i * block_size), &size,
                     reinterpret_cast<const Bytef*>(in), length) != Z_OK ||
          size != wanted) {
        fail("cannot be decompressed");
      }
      in += length;
    }
    return out;
  }

  const std::string& path_;
  const VtpEncoding& encoding_;
  const VtpArray& array_;
  uint64_t& left_;
  std::string_view source_;
  bool base64_ = false;
};

template <typename T>
std::vector<double> unpack(const std::string& bytes, bool big) {
  std::vector<double> values(bytes.size() / sizeof(T));
  for (size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<double>(load_value<T>(bytes.data() + i * sizeof(T), big));
  }
  return values;
}

struct Type {
  std::string_view name;
  size_t size;
  std::vector<double> (*unpack)(const std::string& bytes, bool big);
};

const Type* type_of(std::string_view name) {
  static constexpr Type kTypes[] = {
      {"Float32", 4, unpack<float>},   {"Float64", 8, unpack<double>},
      {"Int64", 8, unpack<int64_t>},   {"Int32", 4, unpack<int32_t>},
      {"UInt64", 8, unpack<uint64_t>}, {"UInt32", 4, unpack<uint32_t>},
      {"Int16", 2, unpack<int16_t>},   {"UInt16", 2, unpack<uint16_t>},
      {"Int8", 1, unpack<int8_t>},     {"UInt8", 1, unpack<uint8_t>}};
  for (const Type& type : kTypes) {
    if (type.name == name) return &type;
  }
  return nullptr;
}

}  // namespace

bool is_vtp_number(std::string_view type) {
  return type_of(type) != nullptr;
}

std::vector<double> vtp_values(const std::string& path, const VtpEncoding& encoding,
                               const VtpAppended& appended, const VtpArray& array, uint64_t& left) {
  if (array.format == "ascii") {
    std::vector<double> values;
    TextReader text(path, array.text);
    while (!text.at_end()) values.push_back(text.real());
    return values;
  }
  ArrayReader reader(path, encoding, appended, array, left);
  if (array.format != "binary" && array.format != "appended") reader.fail("has an unknown format");
  const Type* type = type_of(array.type);
  if (type == nullptr) reader.fail("has an unknown type");
  return type->unpack(reader.bytes(type->size), encoding.big_endian);
}

}  // namespace plc::tools
