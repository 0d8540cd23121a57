#include "pyramid/volume.h"

#include <algorithm>
#include <cstring>

#include "pyramid/brick_cache.h"

namespace plc {

namespace {

// A voxel that has so many bytes.
template <class Body>
void with_size(VoxelType type, const Body& body) {
  switch (voxel_size(type)) {
    case 1:
      return body(uint8_t{});
    case 2:
      return body(uint16_t{});
    default:
      return body(uint32_t{});
  }
}

}  // namespace

void read_voxels(const VolumeView& volume, size_t first, size_t count, void* to) {
  const size_t size = voxel_size(volume.type);
  if (volume.bricks == nullptr) {
    std::memcpy(to, static_cast<const char*>(volume.voxels) + first * size, count * size);
    return;
  }
  const auto width = static_cast<size_t>(volume.dims[0]);
  const auto rows = static_cast<size_t>(volume.dims[1]);
  const BrickReads reads(volume.bricks.get());
  with_size(volume.type, [&](auto voxel) {
    auto* out = static_cast<decltype(voxel)*>(to);
    while (count > 0) {
      const size_t row = first / width, x = first % width;
      const size_t length = std::min(width - x, count);
      volume.bricks->visit_row<decltype(voxel)>(
          static_cast<int64_t>(row % rows), static_cast<int64_t>(row / rows),
          static_cast<int64_t>(x), static_cast<int64_t>(x + length),
          [&](const auto* voxels, int64_t, int64_t n) { out = std::copy_n(voxels, n, out); });
      first += length;
      count -= length;
    }
  });
}

}  // namespace plc
