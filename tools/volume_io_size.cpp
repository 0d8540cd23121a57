// Does a file hold the voxels its header speaks of? ITK's readers of NIfTI and MetaImage leave what
// is missing as it happens to be, its reader of TIFF drops the pages it does not find.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <system_error>

#include "tools/mesh_io_text.h"
#include "tools/volume_io_formats.h"
#include "tools/volume_io_memory.h"

namespace plc::tools {
namespace {

uint64_t voxels_of(const ItkHeader& header) {
  uint64_t count = 1;
  for (const int64_t dim : header.dims) count *= static_cast<uint64_t>(dim);
  return count;
}

[[noreturn]] void too_short(const std::string& path, uint64_t found, uint64_t needed) {
  throw Failure{path + ": is truncated (holds " + std::to_string(found) +
                " bytes of voxels, its header asks for " + std::to_string(needed) + ")"};
}

void require_bytes(const std::string& path, uint64_t found, uint64_t needed) {
  if (found < needed) too_short(path, found, needed);
}

uint64_t size_of(const std::string& path) {
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw Failure{path + ": cannot be read: " + error.message()};
  return size;
}

// No stream of zlib unpacks to more than 1032 times its size: what claims more is not unpacked.
void require_ratio(const std::string& path, uint64_t packed, uint64_t needed) {
  constexpr uint64_t kMaxRatio = 1040;
  if (packed < needed / kMaxRatio) too_short(path, packed, needed);
}

struct NiftiLayout {
  uint64_t offset = 0;  // of the voxels
  uint64_t voxel_bytes = 0;
  bool is_float = false;
  bool big_endian = false;
};

NiftiLayout nifti_layout(const std::string& path, const std::array<char, 544>& bytes) {
  constexpr int32_t kSize1 = 348;
  constexpr int32_t kSize2 = 540;
  constexpr int16_t kFloat32 = 16;
  constexpr int16_t kFloat64 = 64;
  const char* at = bytes.data();
  for (const bool big : {false, true}) {
    const auto size = load_value<int32_t>(at, big);
    if (size != kSize1 && size != kSize2) continue;
    const char* type_at = at + (size == kSize1 ? 70 : 12);  // bitpix follows
    const double offset = size == kSize1 ? static_cast<double>(load_value<float>(at + 108, big))
                                         : static_cast<double>(load_value<int64_t>(at + 168, big));
    const auto type = load_value<int16_t>(type_at, big);
    if (!(offset >= 0 && offset < 1e15)) break;
    return {static_cast<uint64_t>(offset), load_value<uint16_t>(type_at + 2, big) / 8U,
            type == kFloat32 || type == kFloat64, big};
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
  const uint64_t needed = voxels_of(header) * layout.voxel_bytes;
  const uint64_t size = size_of(path);
  if (gzdirect(file.get()) != 0) {
    require_bytes(path, size - std::min(size, layout.offset), needed);
    if (!layout.is_float) return;
  } else {
    require_ratio(path, size, needed);
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

// Unpacks the rest of the file without keeping it.
void check_zlib(const std::string& path, std::ifstream& file, uint64_t packed, uint64_t needed) {
  require_ratio(path, packed, needed);
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

// The lines "Key = value" of a MetaImage up to ElementDataFile, which ends the header.
std::map<std::string, std::string> meta_fields(std::ifstream& file) {
  const auto trimmed = [](const std::string& text) {
    const char* const space = " \t\r";
    const size_t begin = text.find_first_not_of(space);
    if (begin == std::string::npos) return std::string();
    return text.substr(begin, text.find_last_not_of(space) - begin + 1);
  };
  constexpr int kMaxLines = 10000;
  std::map<std::string, std::string> fields;
  std::string line;
  for (int i = 0; i < kMaxLines && std::getline(file, line); ++i) {
    const size_t split = line.find_first_of("=:");
    if (split == std::string::npos) continue;
    const std::string key = trimmed(line.substr(0, split));
    fields[key] = trimmed(line.substr(split + 1));
    if (key == "ElementDataFile") break;
  }
  return fields;
}

bool is_true(const std::string& value) {
  return !value.empty() && (value[0] == 'T' || value[0] == 't' || value[0] == '1');
}

void check_meta(const std::string& path, const ItkHeader& header) {
  std::ifstream file(path, std::ios::binary);
  std::map<std::string, std::string> fields = meta_fields(file);
  const std::string data_name = fields["ElementDataFile"];
  if (data_name.empty()) throw Failure{path + ": is truncated (its header has no end)"};
  const bool local = data_name == "LOCAL" || data_name == "Local" || data_name == "local";
  // One file per slice, or text: ITK's own affair.
  if (data_name.rfind("LIST", 0) == 0 || data_name.find('%') != std::string::npos) return;
  if (fields.count("BinaryData") != 0 && !is_true(fields["BinaryData"])) return;
  std::string data_path = path;
  if (!local) {
    data_path = (std::filesystem::path(path).parent_path() / data_name).string();
    file.close();
    file.open(data_path, std::ios::binary);
  }
  if (!file) throw Failure{path + ": its data file " + data_path + " cannot be read"};
  const auto begin = static_cast<uint64_t>(local ? static_cast<int64_t>(file.tellg()) : 0);
  const uint64_t rest = size_of(data_path) - begin;
  const uint64_t needed = voxels_of(header) * component_size(header.component);
  if (!is_true(fields["CompressedData"])) {
    require_bytes(data_path, rest, needed);
    return;
  }
  if (local && fields["CompressedDataSize"].empty()) {
    throw Failure{path + ": its header does not have CompressedDataSize"};
  }
  check_zlib(data_path, file, rest, needed);
}

}  // namespace

void check_file_size(const std::string& path, ItkFormat format, const ItkHeader& header) {
  switch (format) {
    case ItkFormat::kNifti:
      return check_nifti(path, header);
    case ItkFormat::kMeta:
      return check_meta(path, header);
    case ItkFormat::kTiff:
      return check_tiff_size(path);
    case ItkFormat::kDicom:
      return check_dicom_size(path);
    case ItkFormat::kNrrd:
      return;  // its reader notices
  }
}

}  // namespace plc::tools
