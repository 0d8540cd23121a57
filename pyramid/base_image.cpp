#include "pyramid/base_image.h"

#include <algorithm>
#include <cstddef>

#include "pyramid/pyramid.h"

namespace plc {

namespace {

// Voxels per task of voxel_range: enough to hide the cost of a task.
constexpr size_t kRangeVoxels = size_t{1} << 18;

const uint8_t* voxel_address(const VolumeView& volume, size_t index) {
  return static_cast<const uint8_t*>(volume.voxels) + index * voxel_size(volume.type);
}

}  // namespace

void make_base_image(const VolumeView& volume, const Window& window, int64_t pad, double pad_value,
                     const Executor& executor, SimdTarget simd, float* values) {
  const auto border = static_cast<size_t>(pad);
  const auto m = static_cast<size_t>(volume.dims[0]);
  const auto n = static_cast<size_t>(volume.dims[1]);
  const auto p = static_cast<size_t>(volume.dims[2]);
  const size_t row_size = m + 2 * border;
  const size_t plane_size = row_size * (n + 2 * border);
  const auto pad_to =
      static_cast<float>(std::clamp((pad_value - window.low) * window.scale, 0.0, 1.0));
  executor.run(p + 2 * border, [&](size_t z) {
    float* plane = values + z * plane_size;
    if (z < border || z >= border + p) {
      std::fill_n(plane, plane_size, pad_to);
      return;
    }
    std::fill_n(plane, border * row_size, pad_to);
    for (size_t y = 0; y < n; ++y) {
      float* row = plane + (border + y) * row_size;
      std::fill_n(row, border, pad_to);
      kernels::normalize_voxels(simd, volume.type,
                                voxel_address(volume, ((z - border) * n + y) * m), m, window.low,
                                window.scale, row + border);
      std::fill_n(row + border + m, border, pad_to);
    }
    std::fill_n(plane + (border + n) * row_size, border * row_size, pad_to);
  });
}

VoxelRange voxel_range(const VolumeView& volume, const Executor& executor, SimdTarget simd) {
  const auto count = static_cast<size_t>(volume.dims[0] * volume.dims[1] * volume.dims[2]);
  const size_t tasks = (count + kRangeVoxels - 1) / kRangeVoxels;
  std::vector<kernels::VoxelExtent> parts(tasks);
  executor.run(tasks, [&](size_t task) {
    const size_t begin = task * kRangeVoxels;
    parts[task] = kernels::voxel_extent(simd, volume.type, voxel_address(volume, begin),
                                        std::min(kRangeVoxels, count - begin));
  });
  VoxelRange range;
  bool any = false;
  for (size_t task = 0; task < tasks; ++task) {
    const kernels::VoxelExtent& part = parts[task];
    range.not_finite += static_cast<int64_t>(part.not_finite);
    if (part.not_finite == std::min(kRangeVoxels, count - task * kRangeVoxels)) continue;
    range.low = any ? std::min(range.low, part.low) : part.low;
    range.high = any ? std::max(range.high, part.high) : part.high;
    any = true;
  }
  return range;
}

}  // namespace plc
