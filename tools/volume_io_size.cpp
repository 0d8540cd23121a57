#include "tools/volume_io_size.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <system_error>

#include "tools/mesh_io_text.h"
#include "tools/printable.h"

namespace plc::tools {
namespace {

[[noreturn]] void too_short(const std::string& path, uint64_t found, uint64_t needed) {
  throw Failure{path + ": is truncated (holds " + std::to_string(found) +
                " bytes of voxels, its header asks for " + std::to_string(needed) + ")"};
}

struct NiftiLayout {
  uint64_t offset = 0;  // of the voxels
  uint64_t voxel_bytes = 0;
  bool is_float = false;
  bool big_endian = false;
};

constexpr int16_t kNiftiF32 = 16;
constexpr int16_t kNiftiF64 = 64;

// As its library has it: what the header says of bits per voxel is not used. 0: no scalar.
uint64_t nifti_voxel_bytes(int16_t type) {
  switch (type) {
    case 2:
    case 256:
      return 1;
    case 4:
    case 512:
      return 2;
    case 8:
    case kNiftiF32:
    case 768:
      return 4;
    case kNiftiF64:
    case 1024:
    case 1280:
      return 8;
    default:
      return 0;
  }
}

NiftiLayout nifti_layout(const std::string& path, const std::array<char, 544>& bytes) {
  constexpr int32_t kSize1 = 348;
  constexpr int32_t kSize2 = 540;
  const char* at = bytes.data();
  for (const bool big : {false, true}) {
    const auto size = load_value<int32_t>(at, big);
    if (size != kSize1 && size != kSize2) continue;
    const double offset = size == kSize1 ? static_cast<double>(load_value<float>(at + 108, big))
                                         : static_cast<double>(load_value<int64_t>(at + 168, big));
    const auto type = load_value<int16_t>(at + (size == kSize1 ? 70 : 12), big);
    const uint64_t voxel = nifti_voxel_bytes(type);
    if (!(offset >= 0 && offset < 1e15) || voxel == 0) break;
    return {static_cast<uint64_t>(offset), voxel, type == kNiftiF32 || type == kNiftiF64, big};
  }
  throw Failure{path + ": is not a readable NIfTI file"};
}

// NIfTI's library replaces NaN and infinity by 0 and says nothing. The bytes are whole voxels.
void require_finite(const std::string& path, const NiftiLayout& layout, const char* bytes,
                    size_t size) {
  for (size_t at = 0; at + layout.voxel_bytes <= size; at += layout.voxel_bytes) {
    const double value = layout.voxel_bytes == sizeof(float)
                             ? static_cast<double>(load_value<float>(bytes + at, layout.big_endian))
                             : load_value<double>(bytes + at, layout.big_endian);
    if (!std::isfinite(value)) throw Failure{path + ": has voxels that are NaN or infinite"};
  }
}

// gzread() passes files through that are not compressed.
void check_nifti(const std::string& path, const ItkHeader& header) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (file == nullptr) throw Failure{path + ": cannot be read"};
  std::array<char, 544> first{};
  if (gzread(file.get(), first.data(), first.size()) < 348) {
    throw Failure{path + ": is truncated (its header is not whole)"};
  }
  const NiftiLayout layout = nifti_layout(path, first);
  const uint64_t needed = product_of(header.dims, layout.voxel_bytes);
  const uint64_t size = size_of(path);
  if (gzdirect(file.get()) != 0) {
    require_bytes(path, size - std::min(size, layout.offset), needed);
    if (!layout.is_float) return;
  } else {
    require_ratio(path, size, needed, kZlibRatio);
  }
  if (gzseek(file.get(), static_cast<z_off_t>(layout.offset), SEEK_SET) < 0) {
    too_short(path, 0, needed);
  }
  std::vector<char> buffer(size_t{1} << 18);
  uint64_t unpacked = 0;
  while (unpacked < needed) {
    const auto wanted = std::min<uint64_t>(buffer.size(), needed - unpacked);
    const int got = gzread(file.get(), buffer.data(), static_cast<unsigned>(wanted));
    if (got < 0) throw Failure{path + ": is truncated or damaged (its gzip stream is not whole)"};
    if (got == 0) too_short(path, unpacked, needed);
    unpacked += static_cast<uint64_t>(got);
    if (layout.is_float) require_finite(path, layout, buffer.data(), static_cast<size_t>(got));
  }
  // On to the end, where the checksum is.
  int got = 0;
  do {
    got = gzread(file.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
  } while (got > 0);
  int error = Z_OK;
  gzerror(file.get(), &error);
  if (got < 0 || error != Z_OK) {
    throw Failure{path + ": is truncated or damaged (its gzip stream is not whole)"};
  }
}

}  // namespace

uint64_t times(uint64_t a, uint64_t b) {
  constexpr uint64_t kMost = std::numeric_limits<uint64_t>::max();
  return b != 0 && a > kMost / b ? kMost : a * b;
}

uint64_t product_of(const std::vector<int64_t>& dims, uint64_t bytes) {
  for (const int64_t dim : dims) bytes = times(bytes, static_cast<uint64_t>(dim));
  return bytes;
}

uint64_t voxel_bytes(const ItkHeader& header) {
  return product_of(header.dims, component_size(header.component));
}

uint64_t size_of(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) throw Failure{path + ": cannot be read"};
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw Failure{path + ": cannot be read: " + error.message()};
  return size;
}

std::string beside(const std::string& path, const std::string& name) {
  constexpr size_t kLongest = 255;
  if (name.empty() || name.size() > kLongest || !is_printable(name)) {
    throw Failure{path + ": names a file \"" + printable(name) + "\", which cannot be"};
  }
  return (std::filesystem::path(path).parent_path() / name).string();
}

void require_bytes(const std::string& path, uint64_t found, uint64_t needed) {
  if (found < needed) too_short(path, found, needed);
}

void require_ratio(const std::string& path, uint64_t packed, uint64_t needed, uint64_t ratio) {
  if (packed < needed / ratio) too_short(path, packed, needed);
}

void check_zlib(const std::string& path, std::ifstream& file, uint64_t packed, uint64_t needed) {
  require_ratio(path, packed, needed, kZlibRatio);
  z_stream stream{};
  constexpr int kZlibOrGzip = 15 + 32;
  if (inflateInit2(&stream, kZlibOrGzip) != Z_OK) throw Failure{path + ": not enough memory"};
  const std::unique_ptr<z_stream, int (*)(z_stream*)> owner(&stream, inflateEnd);
  std::vector<char> in(size_t{1} << 16);
  std::vector<char> out(size_t{1} << 18);
  int status = Z_OK;
  uint64_t unpacked = 0;  // stream.total_out, of 64 bits everywhere
  while (status == Z_OK && packed > 0) {
    file.read(in.data(), static_cast<std::streamsize>(std::min<uint64_t>(packed, in.size())));
    if (file.gcount() == 0) break;
    packed -= static_cast<uint64_t>(file.gcount());
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(file.gcount());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(out.data());
      stream.avail_out = static_cast<uInt>(out.size());
      status = inflate(&stream, Z_NO_FLUSH);
      unpacked += out.size() - stream.avail_out;
    } while (status == Z_OK && stream.avail_out == 0);
    if (status == Z_BUF_ERROR) status = Z_OK;  // it wants more
  }
  if (status != Z_STREAM_END && status != Z_OK) {
    throw Failure{path + ": is damaged (its voxels cannot be unpacked)"};
  }
  require_bytes(path, unpacked, needed);
}

void check_file_size(const std::string& path, ItkFormat format, const ItkHeader& header) {
  switch (format) {
    case ItkFormat::kNifti:
      return check_nifti(path, header);
    case ItkFormat::kMeta:
      return check_meta_size(path, header);
    case ItkFormat::kTiff:
      return check_tiff_size(path, header);
    case ItkFormat::kDicom:
      return check_dicom_size(path);
    case ItkFormat::kNrrd:
      return check_nrrd_size(path, header);
  }
}

}  // namespace plc::tools
