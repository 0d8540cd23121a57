// Volumes from folders of slices: DICOM series and TIFF files.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tools/file/failure.h"
#include "tools/file/path_suffix.h"
#include "tools/volume/volume_io_formats.h"

namespace plc::tools {
namespace {

struct Slice {
  std::string file;
  ItkHeader header;
  double position = 0;  // along the stack's normal, mm
};

// Names with numbers in the order of the numbers: slice9 before slice10.
bool natural_less(const std::string& a, const std::string& b) {
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  size_t i = 0;
  size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!digit(a[i]) || !digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
      continue;
    }
    while (i < a.size() && a[i] == '0') ++i;
    while (j < b.size() && b[j] == '0') ++j;
    size_t i_end = i;
    size_t j_end = j;
    while (i_end < a.size() && digit(a[i_end])) ++i_end;
    while (j_end < b.size() && digit(b[j_end])) ++j_end;
    if (i_end - i != j_end - j) return i_end - i < j_end - j;
    const int order = a.compare(i, i_end - i, b, j, j_end - j);
    if (order != 0) return order < 0;
    i = i_end;
    j = j_end;
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;  // they differ in leading zeros only
}

// GDCM leaves a folder at the first entry that is neither file nor folder, and the slices that come
// after it with it.
void require_files(const std::string& folder) {
  std::error_code error;
  for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end;
       i.increment(error)) {
    std::error_code none;
    const std::filesystem::file_status status = i->status(none);
    if (std::filesystem::is_regular_file(status) || std::filesystem::is_directory(status)) continue;
    throw Failure{i->path().string() + ": is not a file, in a folder of files that are read"};
  }
  if (error) throw Failure{folder + ": cannot be read: " + error.message()};
}

std::vector<std::string> tiff_files(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (std::filesystem::directory_iterator i(folder, error), end; !error && i != end;
       i.increment(error)) {
    const std::string suffix = path_suffix(i->path().string());
    if (suffix == ".tif" || suffix == ".tiff") files.push_back(i->path().string());
  }
  if (error) throw Failure{folder + ": cannot be read: " + error.message()};
  std::sort(files.begin(), files.end(), natural_less);
  return files;
}

// The common type of slices: rescaling may make one slice i16 and the next f32.
ItkComponent common_component(ItkComponent a, ItkComponent b) {
  return a == b ? a : ItkComponent::kF64;
}

template <typename T>
double load(const std::byte* data) {
  T value;
  std::copy(data, data + sizeof value, reinterpret_cast<std::byte*>(&value));
  return static_cast<double>(value);
}

double as_double(ItkComponent component, const std::byte* data) {
  switch (component) {
    case ItkComponent::kU8:
      return load<uint8_t>(data);
    case ItkComponent::kI8:
      return load<int8_t>(data);
    case ItkComponent::kU16:
      return load<uint16_t>(data);
    case ItkComponent::kI16:
      return load<int16_t>(data);
    case ItkComponent::kU32:
      return load<uint32_t>(data);
    case ItkComponent::kI32:
      return load<int32_t>(data);
    case ItkComponent::kU64:
      return load<uint64_t>(data);
    case ItkComponent::kI64:
      return load<int64_t>(data);
    case ItkComponent::kF32:
      return load<float>(data);
    case ItkComponent::kF64:
      return load<double>(data);
  }
  return 0;
}

void read_slice(ItkFormat format, const Slice& slice, ItkComponent wanted, std::byte* voxels) {
  if (slice.header.component == wanted) {
    read_itk_voxels(slice.file, format, slice.header, voxels);
    return;
  }
  size_t count = 1;
  for (const int64_t dim : slice.header.dims) count *= static_cast<size_t>(dim);
  const size_t size = component_size(slice.header.component);
  std::vector<std::byte> raw(count * size);
  read_itk_voxels(slice.file, format, slice.header, raw.data());
  for (size_t i = 0; i < count; ++i) {
    const double value = as_double(slice.header.component, raw.data() + i * size);
    const auto* bytes = reinterpret_cast<const std::byte*>(&value);
    std::copy(bytes, bytes + sizeof value, voxels + i * sizeof value);
  }
}

// A slice's header with one image in it, whatever number of axes the format gives it.
ItkHeader slice_header(const std::string& file, ItkFormat format) {
  check_first(file, format);
  ItkHeader header = read_itk_header(file, format);
  bool single = header.dims.size() >= 2;
  for (size_t axis = 2; axis < header.dims.size(); ++axis) single &= header.dims[axis] == 1;
  if (!single) throw Failure{file + ": holds more than one slice, in a folder of several files"};
  check_file_size(file, format, header);
  return header;
}

std::vector<Slice> read_headers(const std::vector<std::string>& files, ItkFormat format) {
  std::vector<Slice> slices;
  slices.reserve(files.size());
  for (const std::string& file : files) {
    slices.push_back({file, slice_header(file, format), 0});
    const ItkHeader& first = slices.front().header;
    const ItkHeader& header = slices.back().header;
    if (header.dims[0] != first.dims[0] || header.dims[1] != first.dims[1]) {
      throw Failure{file + ": is a slice of another size than " + files.front()};
    }
  }
  return slices;
}

LoadedVolume assemble(const std::string& folder, ItkFormat format, const std::vector<Slice>& slices,
                      ItkHeader header) {
  header.dims = {header.dims[0], header.dims[1], static_cast<int64_t>(slices.size())};
  for (const Slice& slice : slices) {
    header.component = common_component(header.component, slice.header.component);
  }
  header = checked_header(folder, std::move(header));
  SharedBytes voxels = allocate_voxels(folder, header);
  const size_t slice_bytes = voxels.size() / slices.size();
  for (size_t i = 0; i < slices.size(); ++i) {
    read_slice(format, slices[i], header.component, voxels.data() + i * slice_bytes);
  }
  return volume_from(folder, header, std::move(voxels));
}

// The third axis of a stack of slices and the distance between them along it.
struct Stack {
  double axis[3];
  double spacing;
};

// The slices of a tilted gantry are shifted sideways by the same step each: the axis leans.
void lean(Stack& stack, const std::vector<Slice>& slices) {
  constexpr double kUpright = 1e-3;  // sine of the angle; below are the roundings of headers
  double step[3];
  double squared = 0;
  for (int i = 0; i < 3; ++i) {
    step[i] = (slices.back().header.origin[i] - slices.front().header.origin[i]) /
              static_cast<double>(slices.size() - 1);
    squared += step[i] * step[i];
  }
  const double length = std::sqrt(squared);
  if (squared - stack.spacing * stack.spacing <= kUpright * kUpright * squared) return;
  for (int i = 0; i < 3; ++i) stack.axis[i] = step[i] / length;
  stack.spacing = length;
}

// Sorts the slices along their common normal.
Stack sort_by_position(const std::string& folder, std::vector<Slice>& slices) {
  constexpr double kParallel = 1e-3;  // difference of direction cosines
  constexpr double kEven = 0.1;       // of the mean distance: more is a slice lost, or two spacings
  const double* d = slices.front().header.direction;  // columns 0 and 1 are the slice's axes
  Stack stack{{d[3] * d[7] - d[6] * d[4], d[6] * d[1] - d[0] * d[7], d[0] * d[4] - d[3] * d[1]}, 0};
  for (Slice& slice : slices) {
    for (int i = 0; i < 9; ++i) {
      if (i % 3 != 2 && std::abs(slice.header.direction[i] - d[i]) > kParallel) {
        throw Failure{slice.file + ": is not parallel to the other slices of its series"};
      }
    }
    for (int i = 0; i < 3; ++i) slice.position += stack.axis[i] * slice.header.origin[i];
  }
  std::stable_sort(slices.begin(), slices.end(),
                   [](const Slice& a, const Slice& b) { return a.position < b.position; });
  const auto gaps = static_cast<double>(slices.size() - 1);
  stack.spacing = (slices.back().position - slices.front().position) / gaps;
  for (size_t i = 1; i < slices.size(); ++i) {
    const double gap = slices[i].position - slices[i - 1].position;
    if (!(std::abs(gap - stack.spacing) <= kEven * stack.spacing) || !(stack.spacing > 0)) {
      char text[160];
      std::snprintf(text, sizeof text,
                    ": its slices are not evenly spaced (%.4g mm apart on average, %.4g mm before "
                    "slice %zu)",
                    stack.spacing, gap, i + 1);
      throw Failure{folder + text};
    }
  }
  lean(stack, slices);
  return stack;
}

LoadedVolume read_series(const std::string& folder, const std::vector<std::string>& files) {
  if (files.size() == 1) return read_itk_volume(files.front(), ItkFormat::kDicom);
  std::vector<Slice> slices = read_headers(files, ItkFormat::kDicom);
  const Stack stack = sort_by_position(folder, slices);
  ItkHeader header = slices.front().header;
  header.spacing[2] = stack.spacing;
  for (int row = 0; row < 3; ++row) header.direction[3 * row + 2] = stack.axis[row];
  return assemble(folder, ItkFormat::kDicom, slices, std::move(header));
}

}  // namespace

LoadedVolume read_folder(const std::string& path) {
  require_files(path);
  const DicomSeries series = find_dicom_series(path);
  if (!series.files.empty()) {
    LoadedVolume volume = read_series(path, series.files);
    if (series.series_count > 1) {
      volume.warnings.push_back(path + ": holds " + std::to_string(series.series_count) +
                                " series; the largest is read (" +
                                std::to_string(series.files.size()) + " files)");
    }
    return volume;
  }
  const std::vector<std::string> files = tiff_files(path);
  if (files.empty()) throw Failure{path + ": has no DICOM or TIFF files in it"};
  if (files.size() == 1) return read_itk_volume(files.front(), ItkFormat::kTiff);
  std::vector<Slice> slices = read_headers(files, ItkFormat::kTiff);
  return assemble(path, ItkFormat::kTiff, slices, slices.front().header);
}

}  // namespace plc::tools
