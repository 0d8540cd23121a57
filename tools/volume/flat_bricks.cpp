// open_flat_bricks(): the header is read in a child process, as those of all images; the voxels by
// pread(), which a file that becomes shorter does not harm.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tools/file/apart.h"
#include "tools/file/failure.h"
#include "tools/file/path_suffix.h"
#include "tools/volume/flat_file.h"
#include "tools/volume/volume_io_formats.h"
#include "tools/volume/volume_io_memory.h"
#include "tools/volume/volume_io_size.h"

namespace plc::tools {
namespace {

// Long rows: a brick takes a call of the system for each. 256 KiB of bytes.
constexpr BrickSource::Side kBrick{256, 32, 32};

class FlatBricks final : public BrickSource {
 public:
  FlatBricks(const plc_image& image, FlatFile file)
      : BrickSource(image, kBrick),
        file_(std::move(file)),
        descriptor_(open(file_.path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ < 0) throw Failure{file_.path + ": cannot be read: " + std::strerror(errno)};
  }
  ~FlatBricks() override { close(descriptor_); }

  void read(const VoxelBox& box, std::byte* voxels) const override {
    const int64_t* dims = image().dims;
    const size_t stored = component_size(file_.stored.component);
    const auto count = static_cast<size_t>(box.high[0] - box.low[0] + 1);
    std::vector<std::byte> row(count * stored);
    for (int64_t z = box.low[2]; z <= box.high[2]; ++z) {
      for (int64_t y = box.low[1]; y <= box.high[1]; ++y) {
        const auto first = static_cast<uint64_t>((z * dims[1] + y) * dims[0] + box.low[0]);
        read_bytes(file_.offset + first * stored, row);
        convert(file_.stored, row.data(), count, voxels);
        voxels += count * voxel_size(image().type);
      }
    }
  }

 private:
  void read_bytes(uint64_t offset, std::vector<std::byte>& to) const {
    for (size_t done = 0; done < to.size();) {
      const ssize_t got =
          pread(descriptor_, to.data() + done, to.size() - done, static_cast<off_t>(offset + done));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) throw Failure{file_.path + ": cannot be read: " + std::strerror(errno)};
      if (got == 0) throw Failure{file_.path + ": is truncated"};
      done += static_cast<size_t>(got);
    }
  }

  FlatFile file_;
  int descriptor_;
};

struct Found {
  plc_image image{};
  FlatFile file;
  std::vector<std::string> warnings;
};

std::optional<Found> find(const std::string& path, NiftiFrame frame) {
  const std::string suffix = path_suffix(path);
  const bool nrrd = suffix == ".nrrd" || suffix == ".nhdr";
  const bool meta = suffix == ".mha" || suffix == ".mhd";
  Found found;
  ItkHeader header;
  std::optional<FlatFile> file;
  if (suffix == ".nii") {
    file = flat_nifti(path, frame, header, found.warnings);
  } else if (nrrd || meta) {
    const ItkFormat format = nrrd ? ItkFormat::kNrrd : ItkFormat::kMeta;
    check_first(path, format);
    header = checked_header(path, read_itk_header(path, format));
    file = nrrd ? flat_nrrd(path, header) : flat_meta(path, header);
  }
  if (!file) return std::nullopt;
  const std::optional<plc_voxel_type> type = brick_type(file->stored);
  if (!type) return std::nullopt;
  const uint64_t needed = product_of(header.dims, component_size(file->stored.component));
  const uint64_t size = size_of(file->path);
  require_bytes(file->path, size - std::min(size, file->offset), needed);
  found.image = image_from(header, *type);
  found.file = std::move(*file);
  return found;
}

// What the child tells: numbers as they are in memory, then lines.
struct Numbers {
  plc_image image;
  uint64_t offset;
  StoredVoxels stored;
};

Parcel packed(const std::optional<Found>& found) {
  Parcel parcel;
  if (!found) return parcel;
  const Numbers numbers{found->image, found->file.offset, found->file.stored};
  parcel.text.resize(sizeof numbers);
  std::memcpy(parcel.text.data(), &numbers, sizeof numbers);
  parcel.text += found->file.path + '\n';
  for (const std::string& line : found->warnings) parcel.text += line + '\n';
  return parcel;
}

}  // namespace

std::unique_ptr<BrickSource> open_flat_bricks(const std::string& path, NiftiFrame frame) {
  constexpr ApartLimits kLimits{10, uint64_t{512} << 20};  // headers are small
  const std::string text = apart(path, "cannot be read, perhaps it is damaged", kLimits, [&] {
                             return packed(find(path, frame));
                           }).text;
  if (text.empty()) return nullptr;
  Numbers numbers{};
  std::vector<std::string> lines;
  if (text.size() >= sizeof numbers) {
    std::memcpy(static_cast<void*>(&numbers), text.data(), sizeof numbers);
    for (size_t at = sizeof numbers, end = 0; (end = text.find('\n', at)) != std::string::npos;
         at = end + 1) {
      lines.push_back(text.substr(at, end - at));
    }
  }
  if (lines.empty() || voxel_size(numbers.image.type) == 0)
    throw Failure{path + ": cannot be read"};
  auto source = std::make_unique<FlatBricks>(numbers.image,
                                             FlatFile{lines[0], numbers.offset, numbers.stored});
  source->warnings.assign(lines.begin() + 1, lines.end());
  return source;
}

}  // namespace plc::tools
