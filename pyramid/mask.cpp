#include "pyramid/mask.h"

#include <algorithm>
#include <vector>

namespace plc {

namespace {

template <typename T>
bool is_set(T voxel) {
  return voxel < T{0} || voxel > T{0};
}

// body(first voxel of the slice in its own type, index of the slice's first voxel, slice).
template <typename Body>
void for_slices(const VolumeView& volume, const Executor& executor, const Body& body) {
  const auto slice = static_cast<size_t>(volume.dims[0] * volume.dims[1]);
  executor.run(static_cast<size_t>(volume.dims[2]), [&](size_t z) {
    const auto visit = [&](auto type) {
      body(static_cast<const decltype(type)*>(volume.voxels) + z * slice, z * slice, z);
    };
    switch (volume.type) {
      case VoxelType::kU8:
        return visit(uint8_t{});
      case VoxelType::kI16:
        return visit(int16_t{});
      case VoxelType::kU16:
        return visit(uint16_t{});
      case VoxelType::kI32:
        return visit(int32_t{});
      case VoxelType::kF32:
        return visit(float{});
    }
  });
}

}  // namespace

bool is_any_set(const VolumeView& volume, const Executor& executor) {
  const auto slice = static_cast<size_t>(volume.dims[0] * volume.dims[1]);
  std::vector<uint8_t> any(static_cast<size_t>(volume.dims[2]), 0);
  for_slices(volume, executor, [&](const auto* voxels, size_t, size_t z) {
    any[z] = std::any_of(voxels, voxels + slice, [](auto v) { return is_set(v); }) ? 1 : 0;
  });
  return std::any_of(any.begin(), any.end(), [](uint8_t a) { return a != 0; });
}

bool set_voxels(const VolumeView& volume, const Executor& executor, Buffer<uint8_t>& object) {
  const auto slice = static_cast<size_t>(volume.dims[0] * volume.dims[1]);
  object.resize_uninitialized(slice * static_cast<size_t>(volume.dims[2]));
  for_slices(volume, executor, [&](const auto* voxels, size_t first, size_t) {
    for (size_t i = 0; i < slice; ++i) object[first + i] = is_set(voxels[i]) ? 1 : 0;
  });
  return is_any_set({VoxelType::kU8, object.data(), volume.dims, volume.spacing}, executor);
}

}  // namespace plc
