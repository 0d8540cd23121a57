#include "tools/volume/zarr_codecs.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <memory>

#ifdef PELLICLE_BLOSC
#include <blosc.h>
#endif
#ifdef PELLICLE_ZSTD
#include <zstd.h>
#endif

#include "tools/file/failure.h"

namespace plc::tools {
namespace {

constexpr size_t kChecksumBytes = 4;

[[noreturn]] void damaged(const std::string& name, const char* what) {
  throw Failure{name + ": is truncated or damaged (" + what + ")"};
}

#ifdef PELLICLE_BLOSC
void unpack_blosc(const std::string& name, const ZarrBytes& packed, ZarrBytes& to) {
  size_t size = 0;
  if (blosc_cbuffer_validate(packed.data(), packed.size(), &size) != 0 || size != to.size()) {
    damaged(name, "it is no blosc buffer of a chunk's size");
  }
  const int got = blosc_decompress_ctx(packed.data(), to.data(), to.size(), 1);
  if (got < 0 || static_cast<size_t>(got) != to.size()) damaged(name, "blosc does not unpack it");
}
#endif

#ifdef PELLICLE_ZSTD
void unpack_zstd(const std::string& name, const ZarrBytes& packed, ZarrBytes& to) {
  const size_t got = ZSTD_decompress(to.data(), to.size(), packed.data(), packed.size());
  if (ZSTD_isError(got) != 0 || got != to.size()) damaged(name, "zstd does not unpack it");
}
#endif

// zlib counts in 32 bits.
uInt at_most(size_t size) {
  return static_cast<uInt>(std::min<size_t>(size, std::numeric_limits<uInt>::max()));
}

// gzip and zlib, told apart by their first bytes.
void unpack_zlib(const std::string& name, const ZarrBytes& packed, ZarrBytes& to) {
  constexpr int kEitherHeader = 32;
  z_stream stream{};
  if (inflateInit2(&stream, MAX_WBITS + kEitherHeader) != Z_OK) {
    throw Failure{name + ": not enough memory"};
  }
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  // inflate() does not change what it reads; its type says otherwise.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(packed.data()));
  stream.next_out = reinterpret_cast<Bytef*>(to.data());
  const Bytef* const last_in = stream.next_in + packed.size();
  const Bytef* const last_out = stream.next_out + to.size();
  int status = Z_OK;
  while (status == Z_OK) {
    stream.avail_in = at_most(static_cast<size_t>(last_in - stream.next_in));
    stream.avail_out = at_most(static_cast<size_t>(last_out - stream.next_out));
    status = inflate(&stream, Z_NO_FLUSH);
  }
  if (status != Z_STREAM_END || stream.next_out != last_out) {
    damaged(name, "its zlib stream is not whole, or of another size");
  }
}

void unpack_checksum(const std::string& name, ZarrBytes& bytes) {
  uint32_t told = 0;
  for (size_t i = 0; i < kChecksumBytes; ++i) {
    told |= std::to_integer<uint32_t>(bytes[bytes.size() - kChecksumBytes + i]) << (8 * i);
  }
  bytes.resize(bytes.size() - kChecksumBytes);
  if (told != crc32c(bytes)) damaged(name, "its checksum is another one");
}

bool compresses(ZarrCodec codec) {
  return codec != ZarrCodec::kCrc32c;
}

// Of codecs that has_library().
void unpack(const std::string& name, ZarrCodec codec, const ZarrBytes& packed, ZarrBytes& to) {
#ifdef PELLICLE_BLOSC
  if (codec == ZarrCodec::kBlosc) return unpack_blosc(name, packed, to);
#endif
#ifdef PELLICLE_ZSTD
  if (codec == ZarrCodec::kZstd) return unpack_zstd(name, packed, to);
#endif
  if (codec == ZarrCodec::kGzip || codec == ZarrCodec::kZlib) unpack_zlib(name, packed, to);
}

}  // namespace

bool has_library(ZarrCodec codec) {
#ifndef PELLICLE_BLOSC
  if (codec == ZarrCodec::kBlosc) return false;
#endif
#ifndef PELLICLE_ZSTD
  if (codec == ZarrCodec::kZstd) return false;
#endif
  return codec >= ZarrCodec::kBlosc && codec <= ZarrCodec::kCrc32c;
}

const char* package_of(ZarrCodec codec) {
  switch (codec) {
    case ZarrCodec::kBlosc:
      return "libblosc-dev";
    case ZarrCodec::kZstd:
      return "libzstd-dev";
    default:
      return "zlib1g-dev";
  }
}

ZarrBytes zarr_unpack(const std::string& name, const std::vector<ZarrCodec>& codecs,
                      ZarrBytes packed, uint64_t size) {
  const auto compressor = std::find_if(codecs.begin(), codecs.end(), compresses);
  // What the compressor was given has checksums of its own.
  const auto inner = static_cast<size_t>(compressor - codecs.begin());
  for (size_t i = codecs.size(); i-- > 0;) {
    if (compresses(codecs[i])) {
      ZarrBytes unpacked(size + inner * kChecksumBytes);
      unpack(name, codecs[i], packed, unpacked);
      packed = std::move(unpacked);
    } else {
      if (packed.size() < kChecksumBytes) damaged(name, "it has no checksum");
      unpack_checksum(name, packed);
    }
  }
  if (packed.size() != size) {
    throw Failure{name + ": has " + std::to_string(packed.size()) + " bytes of a chunk's " +
                  std::to_string(size)};
  }
  return packed;
}

#ifdef PELLICLE_BLOSC
namespace {
constexpr int kLevel = 3;
}
ZarrBytes zarr_compress(const std::string& name, std::span<const std::byte> bytes,
                        size_t voxel_size) {
  ZarrBytes packed(bytes.size() + BLOSC_MAX_OVERHEAD);
  const int size = blosc_compress_ctx(kLevel, voxel_size > 1 ? BLOSC_SHUFFLE : BLOSC_NOSHUFFLE,
                                      voxel_size, bytes.size(), bytes.data(), packed.data(),
                                      packed.size(), BLOSC_ZSTD_COMPNAME, 0, 1);
  if (size <= 0) throw Failure{name + ": blosc does not pack a chunk"};
  packed.resize(static_cast<size_t>(size));
  return packed;
}
const char* zarr_compressor() {
  return R"({"id": "blosc", "cname": "zstd", "clevel": 3, "shuffle": 1, "blocksize": 0})";
}
#else
ZarrBytes zarr_compress(const std::string& name, std::span<const std::byte> bytes, size_t) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  ZarrBytes packed(size);
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uLong>(bytes.size()),
                1) != Z_OK) {
    throw Failure{name + ": zlib does not pack a chunk"};
  }
  packed.resize(size);
  return packed;
}
const char* zarr_compressor() {
  return R"({"id": "zlib", "level": 1})";
}
#endif

uint32_t crc32c(std::span<const std::byte> bytes) {
  static const auto table = [] {
    constexpr uint32_t kReversed = 0x82F63B78;  // Castagnoli's polynomial, lowest power first
    std::array<uint32_t, 256> made{};
    for (uint32_t i = 0; i < made.size(); ++i) {
      uint32_t value = i;
      for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ ((value & 1) != 0 ? kReversed : 0);
      made[i] = value;
    }
    return made;
  }();
  uint32_t sum = ~uint32_t{0};
  for (const std::byte byte : bytes) {
    sum = sum >> 8 ^ table[(sum ^ std::to_integer<uint32_t>(byte)) & 255];
  }
  return ~sum;
}

}  // namespace plc::tools
