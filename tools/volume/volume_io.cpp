#include "tools/volume/volume_io.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <system_error>
#include <utility>

#include "tools/file/failure.h"
#include "tools/file/memory.h"
#include "tools/file/path_suffix.h"
#include "tools/volume/inv3.h"
#include "tools/volume/ome_zarr.h"
#include "tools/volume/volume_io_formats.h"
#include "tools/volume/volume_io_memory.h"

namespace plc::tools {
namespace {

// Every From here has values that a To holds, or rounds to its nearest.
template <typename From, typename To>
void convert(const SharedBytes& from, LoadedVolume& to) {
  const size_t count = from.size() / sizeof(From);
  for (size_t i = 0; i < count; ++i) {
    From value;
    std::memcpy(&value, from.data() + i * sizeof(From), sizeof(From));
    const auto converted = static_cast<To>(value);  // NOLINT(bugprone-signed-char-misuse): a number
    std::memcpy(to.bytes.data() + i * sizeof(To), &converted, sizeof(To));
  }
}

template <typename From>
bool fits_i32(const SharedBytes& voxels) {
  const size_t count = voxels.size() / sizeof(From);
  for (size_t i = 0; i < count; ++i) {
    From value;
    std::memcpy(&value, voxels.data() + i * sizeof(From), sizeof(From));
    if (!std::in_range<int32_t>(value)) return false;
  }
  return true;
}

template <typename From>
LoadedVolume converted_integers(const std::string& path, const int64_t dims[3],
                                const SharedBytes& voxels) {
  const bool fits = fits_i32<From>(voxels);
  LoadedVolume volume = make_volume(path, fits ? PLC_I32 : PLC_F32, dims);
  if (fits) {
    convert<From, int32_t>(voxels, volume);
  } else {
    convert<From, float>(voxels, volume);
  }
  return volume;
}

LoadedVolume as_they_are(const ItkHeader& header, plc_voxel_type type, SharedBytes voxels) {
  LoadedVolume volume;
  volume.bytes = std::move(voxels);
  volume.image = image_from(header, type);
  volume.image.voxels = volume.bytes.data();
  return volume;
}

double determinant(const double m[9]) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

}  // namespace

ItkHeader checked_header(const std::string& path, ItkHeader header) {
  while (header.dims.size() > 3 && header.dims.back() == 1) header.dims.pop_back();
  if (header.dims.size() != 3) {
    throw Failure{path + ": is " + std::to_string(header.dims.size()) +
                  "-D; a 3-D volume is needed"};
  }
  checked_voxel_count(path, header.dims.data());
  for (int axis = 0; axis < 3; ++axis) {
    if (!(header.spacing[axis] > 0) || !std::isfinite(header.spacing[axis]) ||
        !std::isfinite(header.origin[axis])) {
      throw Failure{path + ": its voxel spacing or origin is not usable"};
    }
  }
  // A rotation, perhaps with a reflection; what gantry tilts leave of it is far above this.
  if (!(std::abs(determinant(header.direction)) > 0.01)) {
    throw Failure{path + ": its axes do not span space (direction cosines)"};
  }
  return header;
}

plc_image image_from(const ItkHeader& header, plc_voxel_type type) {
  plc_image image{};
  image.struct_size = sizeof image;
  image.type = type;
  std::copy_n(header.dims.data(), 3, image.dims);
  std::copy_n(header.spacing, 3, image.spacing);
  std::copy_n(header.origin, 3, image.origin);
  std::copy_n(header.direction, 9, image.direction);
  return image;
}

SharedBytes allocate_voxels(const std::string& path, const ItkHeader& header) {
  const auto count = static_cast<uint64_t>(checked_voxel_count(path, header.dims.data()));
  const uint64_t bytes = count * component_size(header.component);
  const bool converted = component_size(header.component) > 4 ||
                         header.component == ItkComponent::kI8 ||
                         header.component == ItkComponent::kU32;
  require_memory(path, bytes + (converted ? count * 4 : 0));
  allow_for(bytes);
  try {
    return SharedBytes(bytes);
  } catch (const std::bad_alloc&) {
    throw Failure{path + ": not enough memory for " + dims_text(header.dims.data()) + " voxels"};
  }
}

LoadedVolume volume_from(const std::string& path, const ItkHeader& header, SharedBytes voxels) {
  const int64_t* dims = header.dims.data();
  LoadedVolume volume;
  switch (header.component) {
    case ItkComponent::kU8:
      volume = as_they_are(header, PLC_U8, std::move(voxels));
      break;
    case ItkComponent::kI16:
      volume = as_they_are(header, PLC_I16, std::move(voxels));
      break;
    case ItkComponent::kU16:
      volume = as_they_are(header, PLC_U16, std::move(voxels));
      break;
    case ItkComponent::kI32:
      volume = as_they_are(header, PLC_I32, std::move(voxels));
      break;
    case ItkComponent::kF32:
      volume = as_they_are(header, PLC_F32, std::move(voxels));
      break;
    case ItkComponent::kI8:
      volume = make_volume(path, PLC_I16, dims);
      convert<int8_t, int16_t>(voxels, volume);
      break;
    case ItkComponent::kU32:
      volume = converted_integers<uint32_t>(path, dims, voxels);
      break;
    case ItkComponent::kI64:
      volume = converted_integers<int64_t>(path, dims, voxels);
      break;
    case ItkComponent::kU64:
      volume = converted_integers<uint64_t>(path, dims, voxels);
      break;
    case ItkComponent::kF64:
      volume = make_volume(path, PLC_F32, dims);
      convert<double, float>(voxels, volume);
      break;
  }
  const void* first = volume.image.voxels;
  volume.image = image_from(header, volume.image.type);
  volume.image.voxels = first;
  return volume;
}

LoadedVolume read_itk_volume(const std::string& path, ItkFormat format) {
  check_first(path, format);
  const ItkHeader header = checked_header(path, read_itk_header(path, format));
  check_file_size(path, format, header);
  SharedBytes voxels = allocate_voxels(path, header);
  read_itk_voxels(path, format, header, voxels.data());
  return volume_from(path, header, std::move(voxels));
}

LoadedVolume read_volume(const std::string& path, NiftiFrame frame) {
  static const std::map<std::string, ItkFormat> formats = {
      {".nrrd", ItkFormat::kNrrd}, {".nhdr", ItkFormat::kNrrd}, {".mha", ItkFormat::kMeta},
      {".mhd", ItkFormat::kMeta},  {".tif", ItkFormat::kTiff},  {".tiff", ItkFormat::kTiff},
      {".dcm", ItkFormat::kDicom}};
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw Failure{path + ": there is no such file"};
  if (std::filesystem::is_directory(status)) {
    return is_zarr_folder(path) ? read_ome_zarr(path) : read_folder(path);
  }
  if (!std::filesystem::is_regular_file(status)) throw Failure{path + ": is not a file"};
  if (std::filesystem::file_size(path, error) == 0) throw Failure{path + ": is empty"};
  const std::string suffix = path_suffix(path);
  if (suffix == ".inv3") return read_inv3(path);
  if (suffix == ".nii" || suffix == ".nii.gz") return read_nifti(path, frame);
  const auto format = formats.find(suffix);
  if (format == formats.end()) {
    throw Failure{path + ": unknown format (known are .nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd, " +
                  ".tif, .tiff, .dcm, .inv3 and folders of Zarr arrays, DICOM or TIFF files)"};
  }
  return read_itk_volume(path, format->second);
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& line : warnings) {
    std::fprintf(stderr, "pellicle: %s\n", line.c_str());
  }
}

}  // namespace plc::tools
