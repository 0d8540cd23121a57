// What stands between the header that a library has made of a file and the memory for its voxels.
// The libraries' own parsers are not ours: here any header meets any file.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "tests/fuzz/input.h"
#include "tests/fuzz/refusal.h"
#include "tools/volume/volume_io_formats.h"
#include "tools/volume/volume_io_itk.h"

namespace fuzz {

namespace {

using plc::tools::ItkComponent;
using plc::tools::ItkFormat;
using plc::tools::ItkHeader;

// Usually small, sometimes about a power of 2 or anything.
int64_t random_dim(Input& input) {
  switch (input.below(8)) {
    case 0: {
      const uint64_t power = uint64_t{1} << input.below(64);
      return static_cast<int64_t>(power + input.raw<uint8_t>() - 2);
    }
    case 1:
      return input.raw<int64_t>();
    default:
      return input.below(24);
  }
}

ItkHeader random_header(Input& input) {
  constexpr ItkComponent kComponents[] = {
      ItkComponent::kU8,  ItkComponent::kI8,  ItkComponent::kU16, ItkComponent::kI16,
      ItkComponent::kU32, ItkComponent::kI32, ItkComponent::kU64, ItkComponent::kI64,
      ItkComponent::kF32, ItkComponent::kF64};
  ItkHeader header;
  header.component = input.one_of(kComponents);
  const uint32_t axes = input.below(8) == 0 ? input.below(6) : 3;
  for (uint32_t axis = 0; axis < axes; ++axis) header.dims.push_back(random_dim(input));
  if (input.below(8) == 0) {
    header.spacing[input.below(3)] = input.raw<double>();
    header.origin[input.below(3)] = input.raw<double>();
    header.direction[input.below(9)] = input.raw<double>();
  }
  return header;
}

uint64_t bytes_of(const ItkHeader& header) {
  uint64_t bytes = plc::tools::component_size(header.component);
  for (const int64_t dim : header.dims) bytes *= static_cast<uint64_t>(dim);
  return bytes;
}

// No file stands for more voxels than its packing can hold, or memory is taken for nothing.
// `ratio`: of the format's best packing.
void check_volume(Bytes bytes, ItkFormat format, uint64_t ratio) {
  static const ScratchFile scratch;
  Input input(bytes);
  const ItkHeader made = random_header(input);
  scratch.put(input.rest());
  const std::string path = scratch.path();
  // It may be another file that is named: the one that the header leads to.
  read_or_refuse("", [&] {
    const ItkHeader header = plc::tools::checked_header(path, made);
    plc::tools::check_file_size(path, format, header);
    require(bytes_of(header) <= ratio * input.rest().size(), "a file that cannot hold its voxels");
    plc::tools::SharedBytes voxels = plc::tools::allocate_voxels(path, header);
    const plc::tools::LoadedVolume volume =
        plc::tools::volume_from(path, header, std::move(voxels));
    require(volume.image.voxels == volume.bytes.data(), "an image without its voxels");
  });
}

}  // namespace

// A whole file, read without ITK. Scaled bytes become four.
void volume_nifti(Bytes bytes) {
  static const ScratchFile scratch;
  Input input(bytes);
  using plc::tools::NiftiFrame;
  constexpr NiftiFrame kFrames[] = {NiftiFrame::kAuto, NiftiFrame::kSform, NiftiFrame::kQform};
  const NiftiFrame frame = input.one_of(kFrames);
  scratch.put(input.rest());
  read_or_refuse(scratch.path(), [&] {
    const plc::tools::LoadedVolume volume = plc::tools::read_nifti(scratch.path(), frame);
    require(volume.bytes.size() <= 4 * 1040 * input.rest().size(), "voxels of nothing");
    require(volume.image.voxels == volume.bytes.data(), "an image without its voxels");
  });
}

// 1040: zlib's ratio; 65536: above that of any packing of TIFF.
void volume_meta(Bytes input) {
  check_volume(input, ItkFormat::kMeta, 1040);
}
void volume_nrrd(Bytes input) {
  check_volume(input, ItkFormat::kNrrd, 1040);
}
void volume_tiff(Bytes input) {
  check_volume(input, ItkFormat::kTiff, 65536);
}

}  // namespace fuzz
