// Small Zarr hierarchies in memory, made key by key.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/samples/sample_files.h"
#include "tools/file/failure.h"
#include "tools/volume/zarr_codecs.h"
#include "tools/volume/zarr_store.h"

namespace samples {

class ZarrMemory final : public plc::tools::ZarrStore {
 public:
  std::map<std::string, std::string> values;

  std::string name(const std::string& key) const override {
    return key.empty() ? "memory" : "memory/" + key;
  }
  std::optional<uint64_t> size(const std::string& key) const override {
    const auto found = values.find(key);
    if (found == values.end()) return std::nullopt;
    return found->second.size();
  }
  void read(const std::string& key, uint64_t offset, std::span<std::byte> to) const override {
    const std::string& value = values.at(key);
    if (offset > value.size() || to.size() > value.size() - offset) {
      throw plc::tools::Failure{name(key) + ": is truncated"};
    }
    if (!to.empty()) std::memcpy(to.data(), value.data() + offset, to.size());
  }
};

// A zstd frame of one block that is not packed.
inline std::string zstd_frame(const std::string& data) {
  std::string out;
  put<uint32_t>(out, 0xFD2FB528);
  put<uint8_t>(out, 0xA0);  // one segment, its size in four bytes
  put(out, static_cast<uint32_t>(data.size()));
  const auto block = static_cast<uint32_t>(data.size() << 3 | 1);
  for (int i = 0; i < 3; ++i) put(out, static_cast<uint8_t>(block >> (8 * i)));
  return out + data;
}

inline std::string with_checksum(std::string data) {
  put(data, plc::tools::crc32c(std::as_bytes(std::span(data))));
  return data;
}

// voxel(x, y, z) of all voxels of a box, x fastest; beyond `dims` 0.
using ZarrVoxel = std::function<uint16_t(int64_t, int64_t, int64_t)>;
struct ZarrBox {
  std::array<int64_t, 3> first, size;  // x, y, z
};
inline std::string zarr_voxels(const ZarrBox& box, const std::array<int64_t, 3>& dims,
                               const ZarrVoxel& voxel) {
  std::string out;
  for (int64_t z = box.first[2]; z < box.first[2] + box.size[2]; ++z) {
    for (int64_t y = box.first[1]; y < box.first[1] + box.size[1]; ++y) {
      for (int64_t x = box.first[0]; x < box.first[0] + box.size[0]; ++x) {
        const bool inside = x < dims[0] && y < dims[1] && z < dims[2];
        put<uint16_t>(out, inside ? voxel(x, y, z) : uint16_t{0});
      }
    }
  }
  return out;
}

// An OME-Zarr 0.5 image "0" of little-endian u16, sharded: 2 x 2 x 2 chunks of 4 x 3 x 2 voxels in
// a shard, gzip within, the index at the end with its checksum. Chunk (0, 0, 0) is not there.
inline ZarrMemory sharded_zarr(const std::array<int64_t, 3>& dims, const ZarrVoxel& voxel) {
  const std::array<int64_t, 3> chunk{4, 3, 2};
  ZarrMemory store;
  store.values["zarr.json"] =
      R"({"zarr_format": 3, "node_type": "group", "attributes": {"ome": {"version": "0.5",
      "multiscales": [{"axes": [{"name": "z", "type": "space", "unit": "micrometer"},
        {"name": "y", "type": "space", "unit": "micrometer"},
        {"name": "x", "type": "space", "unit": "micrometer"}],
        "datasets": [{"path": "0", "coordinateTransformations": [
          {"type": "scale", "scale": [2000, 1500, 1000]},
          {"type": "translation", "translation": [30000, 20000, 10000]}]}]}]}}})";
  const auto text = [&](size_t axis) { return std::to_string(dims[axis]); };
  store.values["0/zarr.json"] = R"({"zarr_format": 3, "node_type": "array", "shape": [)" + text(2) +
                                ", " + text(1) + ", " + text(0) +
                                R"(], "data_type": "uint16", "fill_value": 7,
      "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [4, 6, 8]}},
      "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
      "codecs": [{"name": "sharding_indexed", "configuration": {"chunk_shape": [2, 3, 4],
        "codecs": [{"name": "bytes", "configuration": {"endian": "little"}},
          {"name": "gzip", "configuration": {"level": 5}}],
        "index_codecs": [{"name": "bytes", "configuration": {"endian": "little"}},
          {"name": "crc32c"}], "index_location": "end"}}]})";
  const auto shards = [&](size_t axis) {
    return (dims[axis] + 2 * chunk[axis] - 1) / (2 * chunk[axis]);
  };
  for (int64_t sz = 0; sz < shards(2); ++sz) {
    for (int64_t sy = 0; sy < shards(1); ++sy) {
      for (int64_t sx = 0; sx < shards(0); ++sx) {
        std::string shard, index;
        for (int64_t i = 0; i < 8; ++i) {
          const std::array<int64_t, 3> at{2 * sx + i % 2, 2 * sy + i / 2 % 2, 2 * sz + i / 4};
          ZarrBox box{{}, chunk};
          bool beyond = false;
          for (size_t axis = 0; axis < 3; ++axis) {
            box.first[axis] = at[axis] * chunk[axis];
            beyond |= box.first[axis] >= dims[axis];
          }
          if (beyond || at == std::array<int64_t, 3>{0, 0, 0}) {
            put(index, UINT64_MAX);
            put(index, UINT64_MAX);
            continue;
          }
          const std::string packed = deflated(zarr_voxels(box, dims, voxel), true);
          put(index, static_cast<uint64_t>(shard.size()));
          put(index, static_cast<uint64_t>(packed.size()));
          shard += packed;
        }
        store.values["0/c/" + std::to_string(sz) + '/' + std::to_string(sy) + '/' +
                     std::to_string(sx)] = shard + with_checksum(index);
      }
    }
  }
  return store;
}

}  // namespace samples
