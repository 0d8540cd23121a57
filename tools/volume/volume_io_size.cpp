#include "tools/volume/volume_io_size.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "tools/file/failure.h"
#include "tools/file/memory.h"
#include "tools/file/printable.h"

namespace plc::tools {
namespace {

[[noreturn]] void too_short(const std::string& path, uint64_t found, uint64_t needed) {
  throw Failure{path + ": is truncated (holds " + std::to_string(found) +
                " bytes of voxels, its header asks for " + std::to_string(needed) + ")"};
}

}  // namespace

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
  allow_for(needed);
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

void check_first(const std::string& path, ItkFormat format) {
  if (format == ItkFormat::kMeta) check_meta_axes(path);
  if (format == ItkFormat::kTiff) check_tiff_pages(path);
}

void check_file_size(const std::string& path, ItkFormat format, const ItkHeader& header) {
  switch (format) {
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
