#include "pyramid/mask.h"

#include <algorithm>
#include <vector>

namespace plc {

namespace {

// Returns whether one of the voxels is set.
template <typename T>
bool set(const void* voxels, size_t begin, size_t end, uint8_t* object) {
  const T* v = static_cast<const T*>(voxels);
  bool any = false;
  for (size_t i = begin; i < end; ++i) {
    const bool is_set = v[i] < T{0} || v[i] > T{0};
    object[i] = is_set ? 1 : 0;
    any = any || is_set;
  }
  return any;
}

}  // namespace

bool set_voxels(const VolumeView& volume, const Executor& executor, Buffer<uint8_t>& object) {
  const auto slice = static_cast<size_t>(volume.dims[0] * volume.dims[1]);
  const auto slices = static_cast<size_t>(volume.dims[2]);
  object.resize(slice * slices);
  std::vector<uint8_t> any(slices, 0);
  executor.run(slices, [&](size_t z) {
    const size_t begin = z * slice;
    const size_t end = begin + slice;
    const auto fill = [&](auto type) {
      return set<decltype(type)>(volume.voxels, begin, end, object.data());
    };
    bool found = false;
    switch (volume.type) {
      case VoxelType::kU8:
        found = fill(uint8_t{});
        break;
      case VoxelType::kI16:
        found = fill(int16_t{});
        break;
      case VoxelType::kU16:
        found = fill(uint16_t{});
        break;
      case VoxelType::kI32:
        found = fill(int32_t{});
        break;
      case VoxelType::kF32:
        found = fill(float{});
        break;
    }
    any[z] = found ? 1 : 0;
  });
  return std::any_of(any.begin(), any.end(), [](uint8_t a) { return a != 0; });
}

}  // namespace plc
