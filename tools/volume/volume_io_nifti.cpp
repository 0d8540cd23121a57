// NIfTI: the voxels go straight from the file into the volume's memory.
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "tools/file/failure.h"
#include "tools/file/text.h"
#include "tools/volume/flat_file.h"
#include "tools/volume/nifti_header.h"
#include "tools/volume/volume_io_formats.h"
#include "tools/volume/volume_io_size.h"

namespace plc::tools {
namespace {

using GzFile = std::unique_ptr<gzFile_s, int (*)(gzFile)>;

constexpr size_t kChunk = size_t{1} << 20;  // bytes

std::optional<ItkComponent> component_of(int datatype) {
  switch (datatype) {
    case 2:
      return ItkComponent::kU8;
    case 4:
      return ItkComponent::kI16;
    case 8:
      return ItkComponent::kI32;
    case 16:
      return ItkComponent::kF32;
    case 64:
      return ItkComponent::kF64;
    case 256:
      return ItkComponent::kI8;
    case 512:
      return ItkComponent::kU16;
    case 768:
      return ItkComponent::kU32;
    case 1024:
      return ItkComponent::kI64;
    case 1280:
      return ItkComponent::kU64;
    default:
      return std::nullopt;
  }
}

ItkComponent stored_component(const std::string& path, int datatype) {
  if (const auto component = component_of(datatype)) return *component;
  constexpr int kComplex[] = {32, 1792, 2048};
  const int values = datatype == 128 ? 3 : datatype == 2304 ? 4 : 0;
  if (values != 0) {
    throw Failure{path + ": has " + std::to_string(values) + " values per voxel; one is needed"};
  }
  const bool complex = std::count(std::begin(kComplex), std::end(kComplex), datatype) > 0;
  throw Failure{path + ": has voxels of a type that is not supported (" +
                (complex ? "complex numbers" : "NIfTI type " + std::to_string(datatype)) + ")"};
}

// gzread() passes files through that are not packed.
class Reader {
 public:
  Reader(const std::string& path, const NiftiHeader& header)
      : path_(path), file_(gzopen(path.c_str(), "rb"), gzclose) {
    if (file_ == nullptr) throw Failure{path + ": cannot be read"};
    if (gzseek(file_.get(), static_cast<z_off_t>(header.offset), SEEK_SET) < 0) damaged();
  }

  void read(std::byte* to, size_t size) {
    while (size > 0) {
      const int got = gzread(file_.get(), to, static_cast<unsigned>(std::min(size, kChunk)));
      if (got < 0) damaged();
      if (got == 0) require_bytes(path_, count_, count_ + size);
      count_ += static_cast<uint64_t>(got);
      to += got;
      size -= static_cast<size_t>(got);
    }
  }

  // On to the end, where gzip's checksum is.
  void finish() {
    std::vector<char> rest(kChunk);
    int got = 0;
    do {
      got = gzread(file_.get(), rest.data(), static_cast<unsigned>(rest.size()));
    } while (got > 0);
    int error = Z_OK;
    gzerror(file_.get(), &error);
    if (got < 0 || error != Z_OK) damaged();
  }

 private:
  [[noreturn]] void damaged() const {
    throw Failure{path_ + ": is truncated or damaged (its gzip stream is not whole)"};
  }
  const std::string& path_;
  GzFile file_;
  uint64_t count_ = 0;  // bytes of voxels so far
};

// Before memory is taken.
void check_size(const std::string& path, const NiftiHeader& header, uint64_t needed) {
  const GzFile file(gzopen(path.c_str(), "rb"), gzclose);
  if (file == nullptr) throw Failure{path + ": cannot be read"};
  const uint64_t size = size_of(path);
  if (gzdirect(file.get()) == 0) return require_ratio(path, size, needed, kZlibRatio);
  require_bytes(path, size - std::min(size, header.offset), needed);
}

void swap_bytes(std::byte* voxels, size_t bytes, size_t size) {
  for (size_t at = 0; size > 1 && at < bytes; at += size) {
    std::reverse(voxels + at, voxels + at + size);
  }
}

// From -> To: the stored voxels and what the header's scale makes of them.
template <typename From, typename To>
void scale(const NiftiHeader& header, const std::byte* from, size_t count, std::byte* to) {
  for (size_t i = 0; i < count; ++i) {
    From voxel;
    std::memcpy(&voxel, from + i * sizeof voxel, sizeof voxel);
    const auto value =
        static_cast<To>(header.slope * static_cast<double>(voxel) + header.intercept);
    std::memcpy(to + i * sizeof value, &value, sizeof value);
  }
}

void scale(const NiftiHeader& header, ItkComponent stored, const std::byte* from, size_t count,
           std::byte* to) {
  switch (stored) {
    case ItkComponent::kU8:
      return scale<uint8_t, float>(header, from, count, to);
    case ItkComponent::kI8:
      return scale<int8_t, float>(header, from, count, to);
    case ItkComponent::kU16:
      return scale<uint16_t, float>(header, from, count, to);
    case ItkComponent::kI16:
      return scale<int16_t, float>(header, from, count, to);
    case ItkComponent::kU32:
      return scale<uint32_t, float>(header, from, count, to);
    case ItkComponent::kI32:
      return scale<int32_t, float>(header, from, count, to);
    case ItkComponent::kU64:
      return scale<uint64_t, float>(header, from, count, to);
    case ItkComponent::kI64:
      return scale<int64_t, float>(header, from, count, to);
    case ItkComponent::kF32:
      return scale<float, float>(header, from, count, to);
    case ItkComponent::kF64:
      return scale<double, double>(header, from, count, to);
  }
}

void read_scaled(Reader& reader, const NiftiHeader& header, ItkComponent stored,
                 ItkComponent component, SharedBytes& voxels) {
  const size_t stored_size = component_size(stored);
  const size_t size = component_size(component);
  std::vector<std::byte> chunk(kChunk);
  const size_t count = voxels.size() / size;
  for (size_t first = 0; first < count; first += kChunk / stored_size) {
    const size_t some = std::min(kChunk / stored_size, count - first);
    reader.read(chunk.data(), some * stored_size);
    if (header.big_endian) swap_bytes(chunk.data(), some * stored_size, stored_size);
    scale(header, stored, chunk.data(), some, voxels.data() + first * size);
  }
}

template <typename T>
void require_finite(const std::string& path, const SharedBytes& voxels) {
  for (size_t at = 0; at + sizeof(T) <= voxels.size(); at += sizeof(T)) {
    T value;
    std::memcpy(&value, voxels.data() + at, sizeof value);
    if (!std::isfinite(value)) throw Failure{path + ": has voxels that are NaN or infinite"};
  }
}

// Of the voxels as they become.
ItkHeader header_of(const std::string& path, const NiftiHeader& nifti, const StoredVoxels& stored,
                    NiftiFrame frame, std::vector<std::string>& warnings) {
  ItkHeader header;
  const bool floats = stored.scaled() && stored.component != ItkComponent::kF64;
  header.component = floats ? ItkComponent::kF32 : stored.component;
  header.dims = nifti.dims;
  warnings = place_nifti(path, nifti, frame, header);
  return checked_header(path, std::move(header));
}

}  // namespace

std::optional<FlatFile> flat_nifti(const std::string& path, NiftiFrame frame, ItkHeader& header,
                                   std::vector<std::string>& warnings) {
  const NiftiHeader nifti = read_nifti_header(path);
  FlatFile file{
      path,
      nifti.offset,
      {stored_component(path, nifti.datatype), nifti.big_endian, nifti.slope, nifti.intercept}};
  header = header_of(path, nifti, file.stored, frame, warnings);
  const GzFile gz(gzopen(path.c_str(), "rb"), gzclose);
  if (gz == nullptr) throw Failure{path + ": cannot be read"};
  if (gzdirect(gz.get()) == 0) return std::nullopt;
  return file;
}

LoadedVolume read_nifti(const std::string& path, NiftiFrame frame) {
  static_assert(std::endian::native == std::endian::little);
  const NiftiHeader nifti = read_nifti_header(path);
  const ItkComponent stored = stored_component(path, nifti.datatype);
  const StoredVoxels how{stored, nifti.big_endian, nifti.slope, nifti.intercept};
  const bool scaled = how.scaled();
  std::vector<std::string> warnings;
  const ItkHeader header = header_of(path, nifti, how, frame, warnings);
  check_size(path, nifti, product_of(header.dims, component_size(stored)));
  SharedBytes voxels = allocate_voxels(path, header);
  Reader reader(path, nifti);
  if (scaled) {
    read_scaled(reader, nifti, stored, header.component, voxels);
  } else {
    reader.read(voxels.data(), voxels.size());
    if (nifti.big_endian) swap_bytes(voxels.data(), voxels.size(), component_size(stored));
  }
  reader.finish();
  if (header.component == ItkComponent::kF32) require_finite<float>(path, voxels);
  if (header.component == ItkComponent::kF64) require_finite<double>(path, voxels);
  LoadedVolume volume = volume_from(path, header, std::move(voxels));
  volume.warnings = std::move(warnings);
  return volume;
}

}  // namespace plc::tools
