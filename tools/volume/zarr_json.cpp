#include "tools/volume/zarr_json.h"

#include "tools/file/failure.h"

namespace plc::tools {

std::optional<ZarrJson> read_zarr_json(const ZarrStore& store, const std::string& key) {
  constexpr uint64_t kMost = uint64_t{1} << 24;  // that of a plate with many wells has a megabyte
  const std::optional<uint64_t> size = store.size(key);
  if (!size) return std::nullopt;
  if (*size > kMost) throw Failure{store.name(key) + ": is too large for metadata"};
  std::string text(*size, '\0');
  store.read(key, 0, std::as_writable_bytes(std::span(text)));
  ZarrJson json = ZarrJson::parse(text, nullptr, false);
  if (!json.is_object()) throw Failure{store.name(key) + ": is damaged (it is no JSON object)"};
  return json;
}

const ZarrJson& member(const ZarrJson& object, const std::string& name) {
  static const ZarrJson none;
  if (!object.is_object()) return none;
  const auto found = object.find(name);
  return found == object.end() ? none : *found;
}

std::string text_member(const ZarrJson& object, const std::string& name) {
  const ZarrJson& value = member(object, name);
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::optional<std::vector<int64_t>> lengths_of(const ZarrJson& list) {
  constexpr size_t kMostAxes = 16;
  constexpr int64_t kLongest = (int64_t{1} << 31) - 1;
  if (!list.is_array() || list.empty() || list.size() > kMostAxes) return std::nullopt;
  std::vector<int64_t> lengths;
  for (const ZarrJson& item : list) {
    if (!item.is_number_unsigned()) return std::nullopt;
    const auto length = item.get<uint64_t>();
    if (length < 1 || length > kLongest) return std::nullopt;
    lengths.push_back(static_cast<int64_t>(length));
  }
  return lengths;
}

std::string zarr_key(const std::string& path, const std::string& name) {
  return path.empty() ? name : path + '/' + name;
}

}  // namespace plc::tools
