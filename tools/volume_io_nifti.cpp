// Voxels of plain NIfTI files straight from the file: ITK reads them into memory of its own first,
// which for a volume of some gigabytes is as much again.
#include <array>
#include <bit>
#include <cstring>
#include <fstream>

#include "tools/volume_io_formats.h"

namespace plc::tools {
namespace {

// Of a NIfTI-1 header, little endian: where what is needed here stands.
constexpr size_t kHeader = 348;
constexpr size_t kDataType = 70;
constexpr size_t kOffset = 108;  // of the voxels, a float
constexpr size_t kSlope = 112;   // value = slope * voxel + intercept; 0: none
constexpr size_t kIntercept = 116;
constexpr size_t kMagic = 344;

using Header = std::array<char, kHeader>;

template <typename T>
T at(const Header& header, size_t place) {
  T value;
  std::memcpy(&value, header.data() + place, sizeof value);
  return value;
}

// DT_UNSIGNED_CHAR .. DT_FLOAT64.
bool is_stored_as(int16_t type, ItkComponent component) {
  switch (component) {
    case ItkComponent::kU8:
      return type == 2;
    case ItkComponent::kI16:
      return type == 4;
    case ItkComponent::kI32:
      return type == 8;
    case ItkComponent::kF32:
      return type == 16;
    case ItkComponent::kU16:
      return type == 512;
    default:
      return false;
  }
}

}  // namespace

bool read_plain_nifti(const std::string& path, const ItkHeader& header, std::byte* voxels) {
  static_assert(std::endian::native == std::endian::little);
  std::ifstream file(path, std::ios::binary);
  Header first{};
  if (!file.read(first.data(), first.size())) return false;
  const auto slope = at<float>(first, kSlope);
  const bool scaled = slope != 0 && !(slope == 1 && at<float>(first, kIntercept) == 0);
  if (at<int32_t>(first, 0) != static_cast<int32_t>(kHeader) || scaled ||
      std::memcmp(first.data() + kMagic, "n+1", 4) != 0 ||
      !is_stored_as(at<int16_t>(first, kDataType), header.component)) {
    return false;
  }
  const auto offset = at<float>(first, kOffset);
  if (!(offset >= static_cast<float>(kHeader) && offset < 1e9F)) return false;
  uint64_t bytes = component_size(header.component);
  for (const int64_t dim : header.dims) bytes *= static_cast<uint64_t>(dim);
  file.seekg(static_cast<std::streamoff>(offset));
  if (!file.read(reinterpret_cast<char*>(voxels), static_cast<std::streamsize>(bytes))) {
    throw Failure{path + ": its voxels cannot be read"};
  }
  return true;
}

}  // namespace plc::tools
