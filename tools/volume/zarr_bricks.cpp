// open_zarr_bricks(): bricks of whole chunks, each unpacked once.
#include <algorithm>
#include <cstring>
#include <utility>

#include "tools/file/failure.h"
#include "tools/volume/brick_source.h"
#include "tools/volume/ome_zarr.h"
#include "tools/volume/stored_voxels.h"
#include "tools/volume/volume_io_formats.h"
#include "tools/volume/volume_io_memory.h"
#include "tools/volume/zarr_gather.h"

namespace plc::tools {
namespace {

// A brick is as many chunks along an axis as have so many voxels together; and no more than that
// in all.
constexpr int64_t kLeastSide = 32;
constexpr int64_t kMostSide = 4096;
constexpr int64_t kMostVoxels = int64_t{1} << 26;

class ZarrBricks final : public BrickSource {
 public:
  ZarrBricks(const plc_image& image, const Side& brick, std::shared_ptr<const ZarrStore> store,
             OmeZarrImage zarr)
      : BrickSource(image, brick), store_(std::move(store)), zarr_(std::move(zarr)) {
    stored_.component = zarr_.array.component;
  }

  void read(const VoxelBox& box, std::byte* voxels) const override {
    if (as_stored(stored_)) return gather(box, voxels);
    size_t count = 1;
    for (size_t a = 0; a < 3; ++a) count *= static_cast<size_t>(box.high[a] - box.low[a] + 1);
    std::vector<std::byte> stored(count * component_size(stored_.component));
    gather(box, stored.data());
    convert(stored_, stored.data(), count, voxels);
  }

 private:
  void gather(const VoxelBox& box, std::byte* voxels) const {
    const ZarrGather gather(zarr_, box, voxels);
    std::vector<int64_t> index = gather.first();
    ZarrBytes values;
    for (;;) {
      const bool there = read_zarr_chunk(*store_, zarr_.array, index, values);
      gather.put(index, there ? values.data() : nullptr);
      size_t axis = index.size();
      while (axis > 0 && index[axis - 1] == gather.last()[axis - 1]) {
        --axis;
        index[axis] = gather.first()[axis];
      }
      if (axis == 0) return;
      ++index[axis - 1];
    }
  }

  std::shared_ptr<const ZarrStore> store_;
  OmeZarrImage zarr_;
  StoredVoxels stored_;  // in the order of bytes of this machine
};

}  // namespace

std::unique_ptr<BrickSource> open_zarr_bricks(const std::string& path) {
  const OmeZarrPlace place = find_ome_zarr(path);
  return open_zarr_bricks(std::make_shared<ZarrFolder>(place.root), place.dataset);
}

std::unique_ptr<BrickSource> open_zarr_bricks(std::shared_ptr<const ZarrStore> store,
                                              const std::string& dataset) {
  OmeZarrImage zarr = open_ome_zarr(*store, dataset);
  StoredVoxels stored;
  stored.component = zarr.array.component;
  const auto type = brick_type(stored);
  if (!type) return nullptr;
  BrickSource::Side brick{};
  int64_t voxels = 1;
  for (size_t a = 0; a < 3; ++a) {
    const int64_t chunk = zarr.array.chunk[zarr.space[a]];
    brick[a] = (std::max(kLeastSide, chunk) + chunk - 1) / chunk * chunk;
    voxels *= std::min(brick[a], kMostSide + 1);
    if (brick[a] <= kMostSide && voxels <= kMostVoxels) continue;
    throw Failure{store->name("") + ": its chunks of " + std::to_string(chunk) +
                  " voxels along an axis are too large to be read one at a time"};
  }
  const plc_image image = image_from(zarr.header, *type);
  return std::make_unique<ZarrBricks>(image, brick, std::move(store), std::move(zarr));
}

}  // namespace plc::tools
