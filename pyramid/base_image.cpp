#include "pyramid/base_image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/image_rows.h"
#include "kernels/image_value.h"
#include "pyramid/brick_cache.h"
#include "pyramid/pyramid.h"

namespace plc {

namespace {

// Voxels per task of voxel_range: enough to hide the cost of a task.
constexpr size_t kRangeVoxels = size_t{1} << 18;

const uint8_t* voxel_address(const VolumeView& volume, size_t index) {
  return static_cast<const uint8_t*>(volume.voxels) + index * voxel_size(volume.type);
}

ImageType borrowed_type(VoxelType type) {
  switch (type) {
    case VoxelType::kU8:
      return ImageType::kU8;
    case VoxelType::kI16:
      return ImageType::kI16;
    case VoxelType::kU16:
      return ImageType::kU16;
    case VoxelType::kF32:
      return ImageType::kF32;
    case VoxelType::kI32:
      break;
  }
  return ImageType::kUnit;
}

// Far inside the range of floats: neither a difference of voxels nor its product overflows. 32-bit
// integers are floats as long as the window ends where floats hold them; what lies beyond is
// clipped.
bool within_floats(const VolumeView& volume, const Window& window) {
  const double most = volume.type == VoxelType::kI32 ? 0x1p24 : 1e30;
  const double scale = window.scale();
  return std::abs(window.low) < most && scale > 1e-30 && scale < 1e30 &&
         std::abs(window.low + 1 / scale) < most;
}

VoxelForm form_of(const VolumeView& volume, const Window& window, int64_t pad, double pad_value) {
  VoxelForm form;
  form.type = borrowed_type(volume.type);
  form.pad = static_cast<int32_t>(pad);
  form.low = static_cast<float>(window.low);
  form.scale = static_cast<float>(window.scale());
  form.pad_value = voxel_value(form, static_cast<float>(pad_value));
  return form;
}

// Row (y, z) of the image: write(first voxel, values) for what lies between its borders.
template <typename Write>
void write_row(const VolumeView& volume, int64_t pad, float border, int64_t y, int64_t z,
               const Write& write, float* values) {
  const int64_t width = volume.dims[0] + 2 * pad;
  const int64_t j = y - pad, k = z - pad;
  std::fill_n(values, width, border);
  if (j < 0 || k < 0 || j >= volume.dims[1] || k >= volume.dims[2]) return;
  write(static_cast<size_t>((k * volume.dims[1] + j) * volume.dims[0]), values + pad);
}

template <typename Body>  // body(y, z, values of the row)
void for_rows(const std::array<int64_t, 3>& dims, const Executor& executor, float* values,
              const Body& body) {
  executor.run(static_cast<size_t>(dims[2]), [&](size_t slice) {
    const auto z = static_cast<int64_t>(slice);
    for (int64_t y = 0; y < dims[1]; ++y) body(y, z, values + (z * dims[1] + y) * dims[0]);
  });
}

// The range of some of the voxels.
struct RangePart {
  VoxelRange range;
  bool any = false;  // finite ones

  // Of `count` more.
  void add(const kernels::VoxelExtent& more, size_t count) {
    range.not_finite += static_cast<int64_t>(more.not_finite);
    if (more.not_finite == count) return;
    range.low = any ? std::min(range.low, more.low) : more.low;
    range.high = any ? std::max(range.high, more.high) : more.high;
    any = true;
  }
};

VoxelRange joined(const std::vector<RangePart>& parts) {
  VoxelRange all;
  bool any = false;
  for (const RangePart& part : parts) {
    all.not_finite += part.range.not_finite;
    if (!part.any) continue;
    all.low = any ? std::min(all.low, part.range.low) : part.range.low;
    all.high = any ? std::max(all.high, part.range.high) : part.range.high;
    any = true;
  }
  return all;
}

// Brick by brick: each is fetched once.
VoxelRange brick_range(const CachedBricks& bricks, VoxelType type, const Executor& executor) {
  const auto count = static_cast<size_t>(bricks.counts().bricks);
  std::vector<RangePart> parts(count);
  executor.run(count, [&](size_t brick) {
    const BrickReads reads(&bricks);
    bricks.visit_brick(static_cast<uint32_t>(brick), [&](const void* row, int64_t length) {
      const auto voxels = static_cast<size_t>(length);
      parts[brick].add(kernels::voxel_extent(executor.simd(), type, row, voxels), voxels);
    });
  });
  return joined(parts);
}

}  // namespace

VoxelForm borrowed_form(const VolumeView& volume, const Window& window, int64_t pad,
                        double pad_value) {
  if (!within_floats(volume, window)) return {};
  const VoxelForm form = form_of(volume, window, pad, pad_value);
  return form.type == ImageType::kUnit ? VoxelForm() : form;
}

VoxelForm converted_form(const VolumeView& volume, const Window& window, int64_t pad,
                         double pad_value, const Executor& executor, Buffer<float>& voxels) {
  if (volume.type != VoxelType::kI32 || !within_floats(volume, window)) return {};
  VoxelForm form = form_of(volume, window, pad, pad_value);
  form.type = ImageType::kF32;
  const auto plane = static_cast<size_t>(volume.dims[0] * volume.dims[1]);
  const auto planes = static_cast<size_t>(volume.dims[2]);
  voxels.resize_uninitialized(plane * planes);
  const auto* from = static_cast<const int32_t*>(volume.voxels);
  executor.run(planes, [&](size_t z) {
    for (size_t i = z * plane; i < (z + 1) * plane; ++i) voxels[i] = static_cast<float>(from[i]);
  });
  return form;
}

float window_value(const VolumeView& volume, const Window& window, double value) {
  if (within_floats(volume, window)) {
    return voxel_value(form_of(volume, window, 0, 0), static_cast<float>(value));
  }
  return static_cast<float>(std::clamp((value - window.low) * window.scale(), 0.0, 1.0));
}

void make_base_image(const VolumeView& volume, const Window& window, int64_t pad, double pad_value,
                     const Executor& executor, float* values) {
  std::array<int64_t, 3> dims = volume.dims;
  for (int64_t& dim : dims) dim += 2 * pad;
  const auto count = static_cast<size_t>(volume.dims[0]);
  const float border = window_value(volume, window, pad_value);
  ImageView image;
  image.data = volume.voxels;
  for (size_t a = 0; a < 3; ++a) image.dims[a] = static_cast<int32_t>(dims[a]);
  image.form = borrowed_form(volume, window, pad, pad_value);
  if (image.form.type != ImageType::kUnit) {
    for_rows(dims, executor, values, [&](int64_t y, int64_t z, float* row) {
      kernels::image_rows(executor.simd(), image, z, y, y + 1, row);
    });
  } else if (within_floats(volume, window)) {
    const VoxelForm form = form_of(volume, window, pad, pad_value);
    const auto* voxels = static_cast<const int32_t*>(volume.voxels);
    const auto write = [&](size_t first, float* to) {
      for (size_t i = 0; i < count; ++i) to[i] = voxel_value(form, voxels[first + i]);
    };
    for_rows(dims, executor, values, [&](int64_t y, int64_t z, float* row) {
      write_row(volume, pad, border, y, z, write, row);
    });
  } else {
    const auto write = [&](size_t first, float* to) {
      kernels::normalize_voxels(executor.simd(), volume.type, voxel_address(volume, first), count,
                                window.low, window.scale(), to);
    };
    for_rows(dims, executor, values, [&](int64_t y, int64_t z, float* row) {
      write_row(volume, pad, border, y, z, write, row);
    });
  }
}

VoxelRange voxel_range(const VolumeView& volume, const Executor& executor) {
  if (volume.bricks != nullptr) return brick_range(*volume.bricks, volume.type, executor);
  const auto count = static_cast<size_t>(volume.dims[0] * volume.dims[1] * volume.dims[2]);
  const size_t tasks = (count + kRangeVoxels - 1) / kRangeVoxels;
  std::vector<RangePart> parts(tasks);
  executor.run(tasks, [&](size_t task) {
    const size_t begin = task * kRangeVoxels;
    parts[task].add(
        kernels::voxel_extent(executor.simd(), volume.type, voxel_address(volume, begin),
                              std::min(kRangeVoxels, count - begin)),
        std::min(kRangeVoxels, count - begin));
  });
  return joined(parts);
}

}  // namespace plc
