// A volume as its owner stores it: voxels in their own type, with their place in patient space.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "kernels/voxels.h"  // VoxelType: kU8, kI16, kU16, kI32, kF32

namespace plc {

class CachedBricks;

// Borrowed, never changed; the owner keeps `voxels` alive as long as the view is used.
struct VolumeView {
  VoxelType type = VoxelType::kU8;
  const void* voxels = nullptr;                  // x fastest, no gaps, aligned as its type
  std::array<int64_t, 3> dims{0, 0, 0};          // M, N, P
  std::array<double, 3> spacing{1, 1, 1};        // mm, > 0
  std::shared_ptr<const CachedBricks> bricks{};  // where voxels is null
};

// to = the voxels first .. first + count - 1, wherever they are.
void read_voxels(const VolumeView& volume, size_t first, size_t count, void* to);

}  // namespace plc
