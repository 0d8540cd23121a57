#include "pyramid/feature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <new>
#include <string>

#include "kernels/sobel.h"
#include "pyramid/base_image.h"
#include "pyramid/check_volume.h"
#include "pyramid/gaussian.h"
#include "pyramid/pyramid.h"
#include "pyramid/sobel_image.h"

namespace plc {

namespace {

Status check_size(const std::array<int64_t, 3>& dims) {
  if (dims[0] * dims[1] * dims[2] < kMaxVoxels) return {};
  return {ErrorCode::kInvalidData,
          "gradient norm of " + voxels_text(dims) + ": expected fewer than 2^31"};
}

Status check_sigma(const VolumeView& volume, double sigma_mm) {
  if (!(std::isfinite(sigma_mm) && sigma_mm >= 0.0)) {
    return {ErrorCode::kInvalidArgument,
            "sigma " + number_text(sigma_mm) + " mm: expected a finite value of 0 or more"};
  }
  for (size_t a = 0; a < 3; ++a) {
    if (std::ceil(3.0 * (sigma_mm / volume.spacing[a])) <= static_cast<double>(volume.dims[a])) {
      continue;
    }
    return {ErrorCode::kInvalidArgument, "sigma " + number_text(sigma_mm) +
                                             " mm: 3 sigma reach beyond the image of " +
                                             voxels_text(volume.dims)};
  }
  return {};
}

// The norms of the gradient of `image`, whose values 0 .. 1 are a range of `width` image units.
// Axes relative to the smallest spacing first: no square overflows, whatever the units are.
bool write_norms(const float* image, const VolumeView& volume, double width,
                 const Executor& executor, float* norm) {
  const double smallest = *std::min_element(volume.spacing.begin(), volume.spacing.end());
  std::array<float, 3> scale{};
  for (size_t a = 0; a < 3; ++a) scale[a] = static_cast<float>(smallest / volume.spacing[a]);
  const auto factor = static_cast<float>(width / smallest);
  return sobel_image(image, volume.dims, scale, executor, [&](const GradientRow& row) {
    kernels::vector_norms(executor.simd(), row.gx, row.gy, row.gz, row.width, factor,
                          norm + row.first);
  });
}

// False, or std::bad_alloc, when memory ran out.
bool build_norm(const VolumeView& volume, double sigma_mm, const Executor& executor,
                Buffer<float>& norm) {
  Buffer<float> other;
  const auto count = static_cast<size_t>(volume.dims[0] * volume.dims[1] * volume.dims[2]);
  norm.resize_uninitialized(count);
  other.resize_uninitialized(count);
  // Relative to its range, a volume loses nothing of its contrast to floats.
  const VoxelRange range = voxel_range(volume, executor);
  const double width = range.high - range.low;
  const Window window{range.low, range.high};
  if (sigma_mm == 0.0) {
    make_base_image(volume, window, 0, range.low, executor, other.data());
  } else {
    make_base_image(volume, window, 0, range.low, executor, norm.data());
    std::array<double, 3> sigma{};
    for (size_t a = 0; a < 3; ++a) sigma[a] = sigma_mm / volume.spacing[a];
    if (!convolve_gaussian(norm.data(), volume.dims, sigma, executor, other.data())) {
      return false;
    }
  }
  return write_norms(other.data(), volume, width, executor, norm.data());
}

}  // namespace

Status gradient_norm(const VolumeView& volume, double sigma_mm, const Executor& executor,
                     Buffer<float>& norm) {
  norm.clear();
  Status status = check_volume(volume);
  if (status.ok()) status = check_size(volume.dims);
  if (status.ok()) status = check_sigma(volume, sigma_mm);
  if (!status.ok()) return status;
  bool enough_memory = true;
  try {
    enough_memory = build_norm(volume, sigma_mm, executor, norm);
  } catch (const std::bad_alloc&) {
    enough_memory = false;
  }
  if (enough_memory) return {};
  norm.clear();
  return {ErrorCode::kOutOfMemory,
          "gradient norm of " + voxels_text(volume.dims) + ": out of memory"};
}

}  // namespace plc
