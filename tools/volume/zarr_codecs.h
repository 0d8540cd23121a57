// How the bytes of a chunk of a Zarr array are packed: blosc, zstd, gzip and zlib, and CRC-32C.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace plc::tools {

enum class ZarrCodec { kBlosc, kZstd, kGzip, kZlib, kCrc32c };

// Whether this build has the library for it; the package that building needs.
bool has_library(ZarrCodec codec);
const char* package_of(ZarrCodec codec);

using ZarrBytes = std::vector<std::byte>;

// What `codecs`, in the order in which they packed it, have made of `size` bytes; one of them at
// most compresses. Throws Failure, which begins with `name`, unless it unpacks to just so many.
ZarrBytes zarr_unpack(const std::string& name, const std::vector<ZarrCodec>& codecs,
                      ZarrBytes packed, uint64_t size);

// By blosc with zstd where there is blosc, else by zlib: what zarr_compressor() names. Throws
// Failure.
ZarrBytes zarr_compress(const std::string& name, std::span<const std::byte> bytes,
                        size_t voxel_size);
// As ".zarray" has it.
const char* zarr_compressor();

// The checksum of RFC 3720, appendix B.4.
uint32_t crc32c(std::span<const std::byte> bytes);

}  // namespace plc::tools
