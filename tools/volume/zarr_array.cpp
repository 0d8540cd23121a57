#include "tools/volume/zarr_array.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>
#include <optional>

#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"
#include "tools/file/printable.h"
#include "tools/volume/zarr_json.h"

namespace plc::tools {
namespace {

static_assert(std::endian::native == std::endian::little,
              "values of chunks are copied as they are");

constexpr uint64_t kMostChunkBytes = (uint64_t{1} << 31) - 1;  // blosc has no more
// A chunk that reaches beyond its array is no reason for much memory.
constexpr uint64_t kMostBeyond = uint64_t{1} << 26;
constexpr size_t kIndexEntry = 16;  // bytes: the place of a chunk in its shard, and its length
constexpr uint64_t kNoChunk = std::numeric_limits<uint64_t>::max();

std::optional<ItkComponent> component_named(const std::string& name) {
  static const std::map<std::string, ItkComponent> known = {
      {"bool", ItkComponent::kU8},     {"int8", ItkComponent::kI8},
      {"uint8", ItkComponent::kU8},    {"int16", ItkComponent::kI16},
      {"uint16", ItkComponent::kU16},  {"int32", ItkComponent::kI32},
      {"uint32", ItkComponent::kU32},  {"int64", ItkComponent::kI64},
      {"uint64", ItkComponent::kU64},  {"float32", ItkComponent::kF32},
      {"float64", ItkComponent::kF64}, {"b1", ItkComponent::kU8},
      {"i1", ItkComponent::kI8},       {"u1", ItkComponent::kU8},
      {"i2", ItkComponent::kI16},      {"u2", ItkComponent::kU16},
      {"i4", ItkComponent::kI32},      {"u4", ItkComponent::kU32},
      {"i8", ItkComponent::kI64},      {"u8", ItkComponent::kU64},
      {"f4", ItkComponent::kF32},      {"f8", ItkComponent::kF64}};
  const auto found = known.find(name);
  if (found == known.end()) return std::nullopt;
  return found->second;
}

template <typename T>
std::array<std::byte, 8> bytes_of(T value) {
  std::array<std::byte, 8> bytes{};
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

// What both versions have, read from the metadata of one array.
class Metadata {
 public:
  Metadata(const ZarrStore& store, ZarrArray& array, const std::string& file)
      : array_(array), name_(store.name(zarr_key(array.path, file))) {
    json_ = read_zarr_json(store, zarr_key(array.path, file)).value_or(ZarrJson::object());
  }
  const ZarrJson& json() const { return json_; }

  [[noreturn]] void fail(const std::string& what) const { throw Failure{name_ + ": " + what}; }

  void take_shape() {
    const auto shape = lengths_of(member(json_, "shape"));
    if (!shape) fail("its shape is not usable");
    array_.shape = *shape;
  }
  void take_type(const std::string& name, const std::string& told) {
    const auto component = component_named(name);
    if (!component) fail("values of type " + printable(told) + " are not supported");
    array_.component = *component;
  }
  std::vector<int64_t> edges(const ZarrJson& list, const char* what) const {
    const auto found = lengths_of(list);
    if (!found || found->size() != array_.shape.size()) {
      fail(std::string("the shape of its ") + what + " is not usable");
    }
    return *found;
  }
  void take_fill() {
    const ZarrJson& fill = member(json_, "fill_value");
    if (fill.is_null()) return;
    if (fill.is_boolean()) {
      array_.fill = bytes_of(uint8_t{fill.get<bool>()});
    } else if (fill.is_string()) {
      array_.fill = named_fill(fill.get<std::string>());
    } else if (fill.is_number()) {
      array_.fill = number_fill(fill);
    } else {
      fail("its fill_value is not usable");
    }
  }

 private:
  template <typename T>
  std::array<std::byte, 8> integer_fill(const ZarrJson& fill) const {
    // Some writers have 0.0 for integers.
    if (fill.is_number_float()) {
      const auto value = fill.get<double>();
      if (value == 0) return {};
    } else if (fill.is_number_unsigned() && std::in_range<T>(fill.get<uint64_t>())) {
      return bytes_of(static_cast<T>(fill.get<uint64_t>()));
    } else if (std::in_range<T>(fill.get<int64_t>())) {
      return bytes_of(static_cast<T>(fill.get<int64_t>()));
    }
    fail("its fill_value is none of its type");
  }
  std::array<std::byte, 8> number_fill(const ZarrJson& fill) const {
    switch (array_.component) {
      case ItkComponent::kU8:
        return integer_fill<uint8_t>(fill);
      case ItkComponent::kI8:
        return integer_fill<int8_t>(fill);
      case ItkComponent::kU16:
        return integer_fill<uint16_t>(fill);
      case ItkComponent::kI16:
        return integer_fill<int16_t>(fill);
      case ItkComponent::kU32:
        return integer_fill<uint32_t>(fill);
      case ItkComponent::kI32:
        return integer_fill<int32_t>(fill);
      case ItkComponent::kU64:
        return integer_fill<uint64_t>(fill);
      case ItkComponent::kI64:
        return integer_fill<int64_t>(fill);
      case ItkComponent::kF32:
        return float_fill(fill.get<double>());
      case ItkComponent::kF64:
        break;
    }
    return bytes_of(fill.get<double>());
  }
  std::array<std::byte, 8> float_fill(double value) const {
    if (array_.component == ItkComponent::kF64) return bytes_of(value);
    // Beyond the range of floats a conversion would have no result.
    constexpr double kMost = std::numeric_limits<float>::max();
    if (std::abs(value) > kMost && !std::isinf(value)) fail("its fill_value is none of its type");
    return bytes_of(static_cast<float>(value));
  }
  std::array<std::byte, 8> named_fill(const std::string& text) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const size_t size = component_size(array_.component);
    const bool is_float =
        array_.component == ItkComponent::kF32 || array_.component == ItkComponent::kF64;
    if (is_float && text == "NaN") return float_fill(std::numeric_limits<double>::quiet_NaN());
    if (is_float && text == "Infinity") return float_fill(kInfinity);
    if (is_float && text == "-Infinity") return float_fill(-kInfinity);
    // Its bits as hexadecimal digits, highest first.
    if (is_float && text.size() == 2 + 2 * size && text.starts_with("0x") &&
        text.find_first_not_of("0123456789abcdefABCDEF", 2) == std::string::npos) {
      return bytes_of(static_cast<uint64_t>(std::stoull(text, nullptr, 16)));
    }
    fail("its fill_value is not usable");
  }

  ZarrArray& array_;
  std::string name_;
  ZarrJson json_;
};

std::vector<size_t> in_order(size_t axes) {
  std::vector<size_t> order(axes);
  std::iota(order.begin(), order.end(), size_t{0});
  return order;
}

void add_codec(const Metadata& metadata, ZarrCodec codec, ZarrCoding& coding) {
  if (!has_library(codec)) {
    metadata.fail(std::string("this pellicle was built without ") + package_of(codec));
  }
  const auto compresses = [](ZarrCodec c) { return c != ZarrCodec::kCrc32c; };
  if (compresses(codec) && std::any_of(coding.codecs.begin(), coding.codecs.end(), compresses)) {
    metadata.fail("its chunks are compressed twice, which is not supported");
  }
  coding.codecs.push_back(codec);
}

void take_version_2(Metadata& metadata, ZarrArray& array) {
  const ZarrJson& json = metadata.json();
  array.version_3 = false;
  array.prefix_c = false;
  const std::string type = text_member(json, "dtype");
  if (type.size() < 3 || std::string("<>|").find(type[0]) == std::string::npos) {
    metadata.fail("values of type " + printable(type) + " are not supported");
  }
  metadata.take_shape();
  metadata.take_type(type.substr(1), type);
  array.chunk = metadata.edges(member(json, "chunks"), "chunks");
  array.coding.big_endian = type[0] == '>';
  array.coding.order = in_order(array.shape.size());
  const std::string order = text_member(json, "order");
  if (order == "F") std::reverse(array.coding.order.begin(), array.coding.order.end());
  if (order != "F" && order != "C") metadata.fail("its order is neither C nor F");
  const ZarrJson& filters = member(json, "filters");
  if (!filters.is_null() && !filters.empty()) metadata.fail("filters are not supported");
  const std::string separator =
      json.contains("dimension_separator") ? text_member(json, "dimension_separator") : ".";
  if (separator != "." && separator != "/") metadata.fail("its dimension_separator is not usable");
  array.separator = separator[0];
  metadata.take_fill();
  const ZarrJson& compressor = member(json, "compressor");
  if (compressor.is_null()) return;
  static const std::map<std::string, ZarrCodec> known = {{"blosc", ZarrCodec::kBlosc},
                                                         {"zstd", ZarrCodec::kZstd},
                                                         {"gzip", ZarrCodec::kGzip},
                                                         {"zlib", ZarrCodec::kZlib}};
  const std::string id = text_member(compressor, "id");
  const auto codec = known.find(id);
  if (codec == known.end()) {
    metadata.fail("the compressor \"" + printable(id) + "\" is not supported");
  }
  add_codec(metadata, codec->second, array.coding);
}

// The names of a permutation's axes.
void take_transpose(const Metadata& metadata, const ZarrJson& list, ZarrCoding& coding) {
  std::vector<size_t> order;
  const size_t axes = coding.order.size();
  std::vector<bool> met(axes, false);
  if (list.is_array()) {
    for (const ZarrJson& item : list) {
      if (!item.is_number_unsigned() || item.get<uint64_t>() >= axes) break;
      const auto axis = item.get<size_t>();
      if (met[axis]) break;
      met[axis] = true;
      order.push_back(coding.order[axis]);
    }
  }
  if (order.size() != axes || list.size() != axes) {
    metadata.fail("the order of its transpose codec is not usable");
  }
  coding.order = order;
}

void take_codecs(const Metadata& metadata, const ZarrJson& list, size_t axes, ZarrArray* sharded,
                 ZarrCoding& coding) {
  static const std::map<std::string, ZarrCodec> known = {{"blosc", ZarrCodec::kBlosc},
                                                         {"zstd", ZarrCodec::kZstd},
                                                         {"gzip", ZarrCodec::kGzip},
                                                         {"crc32c", ZarrCodec::kCrc32c}};
  coding.order = in_order(axes);
  if (!list.is_array() || list.empty() || list.size() > 8)
    metadata.fail("its codecs are not usable");
  bool are_bytes = false;
  for (const ZarrJson& item : list) {
    const std::string name = item.is_string() ? item.get<std::string>() : text_member(item, "name");
    const ZarrJson& configuration = member(item, "configuration");
    if (name == "transpose" && !are_bytes) {
      take_transpose(metadata, member(configuration, "order"), coding);
    } else if (name == "bytes" && !are_bytes) {
      coding.big_endian = text_member(configuration, "endian") == "big";
      are_bytes = true;
    } else if (const auto codec = known.find(name); codec != known.end() && are_bytes) {
      add_codec(metadata, codec->second, coding);
    } else if (name == "sharding_indexed" && sharded != nullptr && list.size() == 1) {
      const ZarrJson& inner = member(configuration, "chunk_shape");
      const std::vector<int64_t> shard = sharded->chunk;
      sharded->chunk = metadata.edges(inner, "chunks in shards");
      for (size_t axis = 0; axis < axes; ++axis) {
        if (shard[axis] % sharded->chunk[axis] != 0) {
          metadata.fail("the shape of its shards is no multiple of that of the chunks in them");
        }
        sharded->shard.push_back(shard[axis] / sharded->chunk[axis]);
      }
      take_codecs(metadata, member(configuration, "codecs"), axes, nullptr, coding);
      take_codecs(metadata, member(configuration, "index_codecs"), axes + 1, nullptr,
                  sharded->index_coding);
      const std::string place = text_member(configuration, "index_location");
      if (!place.empty() && place != "start" && place != "end") {
        metadata.fail("the index_location of its shards is not usable");
      }
      sharded->index_at_end = place != "start";
      are_bytes = true;
    } else {
      metadata.fail("the codec \"" + printable(name) + "\" is not supported there");
    }
  }
  if (!are_bytes) metadata.fail("its codecs do not lead to bytes");
}

// An index has a length that is known before it is read, and lies as it is.
void check_index(const Metadata& metadata, const ZarrArray& array) {
  constexpr int64_t kMostChunks = int64_t{1} << 22;  // 64 MiB of index
  int64_t chunks = 1;
  for (const int64_t edge : array.shard) {
    chunks *= edge;
    if (chunks > kMostChunks) metadata.fail("its shards hold too many chunks");
  }
  const ZarrCoding& coding = array.index_coding;
  const bool plain = std::all_of(coding.codecs.begin(), coding.codecs.end(),
                                 [](ZarrCodec c) { return c == ZarrCodec::kCrc32c; });
  if (!plain || coding.order != in_order(array.shape.size() + 1)) {
    metadata.fail("the index of its shards is packed, which is not supported");
  }
}

void take_version_3(Metadata& metadata, ZarrArray& array) {
  const ZarrJson& json = metadata.json();
  if (text_member(json, "node_type") != "array") metadata.fail("is not an array's");
  metadata.take_shape();
  const ZarrJson& type = member(json, "data_type");
  const std::string name = type.is_string() ? type.get<std::string>() : text_member(type, "name");
  metadata.take_type(name.size() < 4 ? "" : name, name);
  const ZarrJson& grid = member(json, "chunk_grid");
  if (text_member(grid, "name") != "regular") metadata.fail("its chunk_grid is not regular");
  array.chunk = metadata.edges(member(member(grid, "configuration"), "chunk_shape"), "chunks");
  const ZarrJson& encoding = member(json, "chunk_key_encoding");
  const std::string way = text_member(encoding, "name");
  if (way != "default" && way != "v2") metadata.fail("its chunk_key_encoding is not supported");
  array.prefix_c = way == "default";
  const std::string separator = text_member(member(encoding, "configuration"), "separator");
  array.separator = separator.empty() ? (array.prefix_c ? '/' : '.') : separator[0];
  if (array.separator != '/' && array.separator != '.')
    metadata.fail("its separator is not usable");
  const ZarrJson& transformers = member(json, "storage_transformers");
  if (!transformers.is_null() && !transformers.empty()) {
    metadata.fail("storage_transformers are not supported");
  }
  metadata.take_fill();
  take_codecs(metadata, member(json, "codecs"), array.shape.size(), &array, array.coding);
  if (!array.shard.empty()) check_index(metadata, array);
}

void check_chunk_size(const ZarrStore& store, const ZarrArray& array) {
  uint64_t bytes = component_size(array.component);
  bool beyond = false;
  for (size_t axis = 0; axis < array.shape.size(); ++axis) {
    bytes = times(bytes, static_cast<uint64_t>(array.chunk[axis]));
    beyond |= array.chunk[axis] > array.shape[axis];
  }
  if (bytes <= (beyond ? kMostBeyond : kMostChunkBytes)) return;
  throw Failure{store.name(array.path) + ": its chunks are too large"};
}

std::string chunk_key(const ZarrArray& array, const std::vector<int64_t>& index) {
  std::string key = array.prefix_c ? "c" : "";
  for (const int64_t i : index) {
    if (!key.empty()) key += array.separator;
    key += std::to_string(i);
  }
  return zarr_key(array.path, key);
}

// Values in the order of the array's axes, little endian.
ZarrBytes in_array_order(const ZarrArray& array, ZarrBytes stored) {
  const size_t size = component_size(array.component);
  if (array.coding.big_endian && size > 1) {
    for (size_t at = 0; at < stored.size(); at += size) {
      std::reverse(stored.begin() + static_cast<ptrdiff_t>(at),
                   stored.begin() + static_cast<ptrdiff_t>(at + size));
    }
  }
  const size_t axes = array.shape.size();
  if (array.coding.order == in_order(axes)) return stored;
  std::vector<size_t> step(axes);  // in the store, of each axis of the array
  size_t next = size;
  for (size_t i = axes; i-- > 0;) {
    step[array.coding.order[i]] = next;
    next *= static_cast<size_t>(array.chunk[array.coding.order[i]]);
  }
  ZarrBytes values(stored.size());
  std::vector<int64_t> at(axes, 0);
  size_t from = 0;
  for (size_t to = 0; to < values.size(); to += size) {
    std::memcpy(values.data() + to, stored.data() + from, size);
    for (size_t axis = axes; axis-- > 0;) {
      from += step[axis];
      if (++at[axis] < array.chunk[axis]) break;
      from -= step[axis] * static_cast<size_t>(array.chunk[axis]);
      at[axis] = 0;
    }
  }
  return values;
}

uint64_t number_at(const std::byte* bytes, bool big_endian) {
  uint64_t value = 0;
  std::memcpy(&value, bytes, sizeof value);
  return big_endian ? __builtin_bswap64(value) : value;
}

// Where a chunk lies in its shard. The checksum is of the whole index, which is why it is read
// whole; else 16 bytes of it are.
struct Place {
  uint64_t offset, bytes;
};
Place place_in_shard(const ZarrStore& store, const ZarrArray& array, const std::string& key,
                     uint64_t size, uint64_t number) {
  const ZarrCoding& coding = array.index_coding;
  uint64_t entries = 1;
  for (const int64_t edge : array.shard) entries *= static_cast<uint64_t>(edge);
  const uint64_t index_bytes = entries * kIndexEntry + 4 * coding.codecs.size();
  if (size < index_bytes) throw Failure{store.name(key) + ": is truncated"};
  const uint64_t first = array.index_at_end ? size - index_bytes : 0;
  ZarrBytes index;
  uint64_t at = number * kIndexEntry;
  if (coding.codecs.empty()) {
    index.resize(kIndexEntry);
    store.read(key, first + at, index);
    at = 0;
  } else {
    index.resize(index_bytes);
    store.read(key, first, index);
    index = zarr_unpack(store.name(key), coding.codecs, std::move(index), entries * kIndexEntry);
  }
  const Place place{number_at(index.data() + at, coding.big_endian),
                    number_at(index.data() + at + 8, coding.big_endian)};
  if (place.offset == kNoChunk && place.bytes == kNoChunk) return place;
  if (place.offset > size || place.bytes > size - place.offset) {
    throw Failure{store.name(key) + ": is damaged (a chunk lies beyond its end)"};
  }
  return place;
}

}  // namespace

size_t ZarrArray::chunk_bytes() const {
  size_t bytes = component_size(component);
  for (const int64_t edge : chunk) bytes *= static_cast<size_t>(edge);
  return bytes;
}

bool is_zarr_array(const ZarrStore& store, const std::string& path) {
  if (store.size(zarr_key(path, ".zarray"))) return true;
  const auto json = read_zarr_json(store, zarr_key(path, "zarr.json"));
  return json && text_member(*json, "node_type") == "array";
}

ZarrArray read_zarr_array(const ZarrStore& store, const std::string& path) {
  ZarrArray array;
  array.path = path;
  if (store.size(zarr_key(path, "zarr.json"))) {
    Metadata metadata(store, array, "zarr.json");
    take_version_3(metadata, array);
  } else if (store.size(zarr_key(path, ".zarray"))) {
    Metadata metadata(store, array, ".zarray");
    take_version_2(metadata, array);
  } else {
    throw Failure{store.name(path) + ": is not a Zarr array (it has no zarr.json and no .zarray)"};
  }
  check_chunk_size(store, array);
  return array;
}

bool read_zarr_chunk(const ZarrStore& store, const ZarrArray& array,
                     const std::vector<int64_t>& index, ZarrBytes& values) {
  std::vector<int64_t> of_key = index;
  uint64_t number = 0;  // of the chunk in its shard
  for (size_t axis = 0; axis < array.shard.size(); ++axis) {
    const int64_t edge = array.shard[axis];
    of_key[axis] = index[axis] / edge;
    number = number * static_cast<uint64_t>(edge) + static_cast<uint64_t>(index[axis] % edge);
  }
  const std::string key = chunk_key(array, of_key);
  const std::optional<uint64_t> size = store.size(key);
  if (!size) return false;
  Place place{0, *size};
  if (!array.shard.empty()) place = place_in_shard(store, array, key, *size, number);
  if (place.offset == kNoChunk) return false;
  // No packing makes a chunk much longer.
  if (place.bytes > array.chunk_bytes() + array.chunk_bytes() / 8 + 4096) {
    throw Failure{store.name(key) + ": is larger than a chunk may be"};
  }
  ZarrBytes packed(place.bytes);
  store.read(key, place.offset, packed);
  values = in_array_order(array, zarr_unpack(store.name(key), array.coding.codecs,
                                             std::move(packed), array.chunk_bytes()));
  return true;
}

}  // namespace plc::tools
