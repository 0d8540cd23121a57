// read_volume_apart(): in a child process, as ITK, GDCM and the libraries under them abort on some
// damaged files and do not end on others.
#include <array>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tools/file/apart.h"
#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"
#include "tools/volume/ome_zarr.h"
#include "tools/volume/volume_io.h"
#include "tools/volume/volume_io_memory.h"

namespace plc::tools {
namespace {

// The bytes of the file, or of all files in the folder; 0 where it cannot be asked for: the reader
// will say why.
uint64_t bytes_on_disk(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) {
    const uintmax_t size = std::filesystem::file_size(path, error);
    return error ? 0 : size;
  }
  uint64_t sum = 0;
  const bool chunks = is_zarr_folder(path);  // in folders of their own
  for (std::filesystem::recursive_directory_iterator i(path, error), end; !error && i != end;
       i.increment(error)) {
    if (!chunks) i.disable_recursion_pending();
    std::error_code none;
    const uintmax_t size = i->file_size(none);
    if (!none) sum = plus(sum, size);
  }
  return sum;
}

// Far above what honest files take: packings of DICOM are read at some megabytes a second.
ApartLimits limits_for(uint64_t file_bytes) {
  constexpr double kSeconds = 10;
  constexpr double kSecondsPerByte = 2e-6;
  constexpr uint64_t kBytes = uint64_t{512} << 20;
  return {kSeconds + kSecondsPerByte * static_cast<double>(file_bytes),
          plus(kBytes, times(file_bytes, 4))};
}

Parcel packed(LoadedVolume volume) {
  volume.image.voxels = nullptr;
  Parcel parcel{std::string(sizeof volume.image, '\0'), std::move(volume.bytes)};
  std::memcpy(parcel.text.data(), &volume.image, sizeof volume.image);
  for (const std::string& line : volume.warnings) parcel.text += line + '\n';
  return parcel;
}

// The child may have gone wrong without a word: what it sends is looked at.
LoadedVolume unpacked(const std::string& path, Parcel parcel) {
  LoadedVolume volume;
  if (parcel.text.size() < sizeof volume.image) throw Failure{path + ": cannot be read"};
  std::memcpy(&volume.image, parcel.text.data(), sizeof volume.image);
  volume.bytes = std::move(parcel.bytes);
  volume.image.voxels = volume.bytes.data();
  const auto count = static_cast<uint64_t>(checked_voxel_count(path, volume.image.dims));
  const size_t size = voxel_size(volume.image.type);
  if (size == 0 || volume.bytes.size() != count * size) throw Failure{path + ": cannot be read"};
  size_t at = sizeof volume.image;
  for (size_t end = 0; (end = parcel.text.find('\n', at)) != std::string::npos; at = end + 1) {
    volume.warnings.push_back(parcel.text.substr(at, end - at));
  }
  return volume;
}

}  // namespace

LoadedVolume read_volume_apart(const std::string& path, NiftiFrame frame) {
  return unpacked(
      path, apart(path, "cannot be read, perhaps it is damaged", limits_for(bytes_on_disk(path)),
                  [&] { return packed(read_volume(path, frame)); }));
}

}  // namespace plc::tools
