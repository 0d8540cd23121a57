// ITK's image readers behind plain types: the only door to ITK.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace plc::tools {

enum class ItkFormat { kNrrd, kMeta, kTiff, kDicom };

// What files hold, ITK's scalar types.
enum class ItkComponent { kU8, kI8, kU16, kI16, kU32, kI32, kU64, kI64, kF32, kF64 };

size_t component_size(ItkComponent component);

struct ItkHeader {
  ItkComponent component = ItkComponent::kU8;
  std::vector<int64_t> dims;  // as many as the file has
  double spacing[3] = {1, 1, 1};
  double origin[3] = {0, 0, 0};
  double direction[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major, columns are the axes, LPS
};

// Throws Failure: not of this format, not readable, or several values per voxel.
ItkHeader read_itk_header(const std::string& path, ItkFormat format);

// All voxels, x fastest, into product(dims) * component_size bytes. Throws Failure.
void read_itk_voxels(const std::string& path, ItkFormat format, const ItkHeader& header,
                     std::byte* voxels);

// Throws Failure where the pixel data of an uncompressed DICOM file end early.
void check_dicom_size(const std::string& path);

// The files of the largest DICOM series of a folder (in no promised order) and the number of
// series; none where there is no DICOM file.
struct DicomSeries {
  std::vector<std::string> files;
  size_t series_count = 0;
};
DicomSeries find_dicom_series(const std::string& folder);

}  // namespace plc::tools
