// One array of a Zarr hierarchy, of version 2 or 3 of the format: what its metadata say, and its
// chunks.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/volume/volume_io_itk.h"
#include "tools/volume/zarr_codecs.h"
#include "tools/volume/zarr_store.h"

namespace plc::tools {

// How values of an array lie in a chunk and are packed.
struct ZarrCoding {
  bool big_endian = false;
  std::vector<size_t> order;      // axes of the array as the chunk stores them, fastest last
  std::vector<ZarrCodec> codecs;  // in the order in which they pack
};

struct ZarrArray {
  std::string path;  // the key of the array; "" is the root of the store
  ItkComponent component = ItkComponent::kU8;
  std::vector<int64_t> shape;       // slowest axis first
  std::vector<int64_t> chunk;       // what is packed by itself; every edge is at least 1
  std::array<std::byte, 8> fill{};  // of chunks that are not there: a value of `component`
  ZarrCoding coding;
  // Where values of the store hold many chunks each ("sharding"): chunks along each axis of one.
  std::vector<int64_t> shard;  // else empty
  ZarrCoding index_coding;     // of the places of the chunks in it
  bool index_at_end = true;
  bool version_3 = true;
  bool prefix_c = true;  // keys "c/1/2/3", else "1/2/3"
  char separator = '/';

  size_t chunk_bytes() const;
  // Chunks along an axis.
  int64_t chunks(size_t axis) const { return (shape[axis] + chunk[axis] - 1) / chunk[axis]; }
};

// Whether the key is that of an array. Throws Failure where its metadata cannot be read.
bool is_zarr_array(const ZarrStore& store, const std::string& path);
// Throws Failure: none there, or what is not supported.
ZarrArray read_zarr_array(const ZarrStore& store, const std::string& path);

// The chunk of these indices, little endian, in the order of the array's axes; false and nothing
// where it is not there and all of it is `fill`. Thread-safe. Throws Failure.
bool read_zarr_chunk(const ZarrStore& store, const ZarrArray& array,
                     const std::vector<int64_t>& index, ZarrBytes& values);

}  // namespace plc::tools
