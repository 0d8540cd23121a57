#include "tools/volume/brick_source.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "tools/volume/flat_file.h"
#include "tools/volume/ome_zarr.h"
#include "tools/volume/volume_io_memory.h"

namespace plc::tools {

namespace {

class BoxOfBricks final : public BrickSource {
 public:
  BoxOfBricks(const plc_image& image, std::unique_ptr<BrickSource> whole, const VoxelBox& box)
      : BrickSource(image, whole->brick()), whole_(std::move(whole)), low_(box.low) {
    warnings = whole_->warnings;
  }
  void read(const VoxelBox& box, std::byte* voxels) const override {
    VoxelBox moved = box;
    for (size_t a = 0; a < 3; ++a) {
      moved.low[a] += low_[a];
      moved.high[a] += low_[a];
    }
    whole_->read(moved, voxels);
  }

 private:
  std::unique_ptr<BrickSource> whole_;
  std::array<int64_t, 3> low_;
};

}  // namespace

std::unique_ptr<BrickSource> open_bricks(const std::string& path, NiftiFrame frame) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    return is_zarr_folder(path) ? open_zarr_bricks(path) : nullptr;
  }
  return std::filesystem::is_regular_file(path, error) ? open_flat_bricks(path, frame) : nullptr;
}

std::unique_ptr<BrickSource> cut_out(const std::string& path, std::unique_ptr<BrickSource> source,
                                     const VoxelBox& box) {
  const plc_image image = image_of_box(path, source->image(), box);
  return std::make_unique<BoxOfBricks>(image, std::move(source), box);
}

void read_brick(const BrickSource& source, const int64_t at[3], std::byte* voxels) {
  VoxelBox box{};
  std::array<int64_t, 3> size{};
  for (size_t a = 0; a < 3; ++a) {
    box.low[a] = at[a] * source.brick()[a];
    size[a] = std::min(source.brick()[a], source.image().dims[a] - box.low[a]);
    box.high[a] = box.low[a] + size[a] - 1;
  }
  if (size == source.brick()) return source.read(box, voxels);
  const size_t voxel = voxel_size(source.image().type);
  std::vector<std::byte> part(static_cast<size_t>(size[0] * size[1] * size[2]) * voxel);
  source.read(box, part.data());
  const auto row = static_cast<size_t>(size[0]) * voxel;
  const std::byte* from = part.data();
  for (int64_t z = 0; z < size[2]; ++z) {
    for (int64_t y = 0; y < size[1]; ++y, from += row) {
      const auto to = static_cast<size_t>((z * source.brick()[1] + y) * source.brick()[0]) * voxel;
      std::memcpy(voxels + to, from, row);
    }
  }
}

}  // namespace plc::tools
