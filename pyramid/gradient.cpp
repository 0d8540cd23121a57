#include "pyramid/gradient.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>

#include "kernels/image_rows.h"
#include "kernels/sobel.h"
#include "pyramid/border.h"
#include "pyramid/check_volume.h"
#include "pyramid/sobel_image.h"

namespace plc {

namespace {

// Bounds and scales beyond these count as these, so that squares stay normal floats; no level of
// values in [0,1] comes near.
constexpr double kLeast = 1e-18;
constexpr double kMost = 1e18;

float within_floats(double value) {
  return static_cast<float>(std::clamp(value, kLeast, kMost));
}

Status check_units(const std::array<double, 3>& voxel_length, double bound) {
  if (!(std::isfinite(bound) && bound > 0.0)) {
    return {ErrorCode::kInvalidArgument,
            "gradient bound " + number_text(bound) + ": expected a finite value greater than 0"};
  }
  for (const double length : voxel_length) {
    if (std::isfinite(length) && length > 0.0) continue;
    return {ErrorCode::kInvalidArgument, "gradient: voxel of " + number_text(voxel_length[0]) +
                                             " x " + number_text(voxel_length[1]) + " x " +
                                             number_text(voxel_length[2]) +
                                             " units: expected finite lengths greater than 0"};
  }
  return {};
}

Status check_size(const std::array<int64_t, 3>& dims) {
  if (dims[0] * dims[1] * dims[2] < kMaxVoxels) return {};
  return {ErrorCode::kInvalidData,
          "gradient of " + voxels_text(dims) + ": expected fewer than 2^31"};
}

void copy_values(const PyramidLevel& level, const Executor& executor, float* values) {
  const ImageView image = level_image(level);
  executor.run(static_cast<size_t>(level.dims[2]), [&](size_t z) {
    const size_t plane = static_cast<size_t>(level.dims[0]) * static_cast<size_t>(level.dims[1]);
    kernels::image_rows(executor.simd(), image, static_cast<int64_t>(z), 0, level.dims[1],
                        values + z * plane);
  });
}

}  // namespace

Status build_gradient(const PyramidLevel& level, const std::array<double, 3>& voxel_length,
                      double bound, const Executor& executor, Buffer<Float4>& gradient) {
  gradient.clear();
  Status status = check_units(voxel_length, bound);
  if (status.ok()) status = check_size(level.dims);
  if (!status.ok()) return status;
  std::array<float, 3> scale{};
  for (size_t a = 0; a < 3; ++a) scale[a] = within_floats(1.0 / voxel_length[a]);
  bool enough_memory = true;
  try {
    const auto voxels = static_cast<size_t>(level.dims[0] * level.dims[1] * level.dims[2]);
    gradient.resize_uninitialized(voxels);
    // The Sobel rows of an I_0 that has a form are read from a copy in floats, a quarter of the
    // gradient's own size.
    Buffer<float> copy;
    const float* values = level.values.data();
    if (level.form.type != ImageType::kUnit || level.values.empty()) {
      copy.resize_uninitialized(voxels);
      copy_values(level, executor, copy.data());
      values = copy.data();
    }
    enough_memory = sobel_image(values, level.dims, scale, executor, [&](const GradientRow& row) {
      kernels::bound_vectors(executor.simd(), row.gx, row.gy, row.gz, row.width,
                             within_floats(bound), gradient.data() + row.first);
    });
  } catch (const std::bad_alloc&) {
    enough_memory = false;
  }
  if (enough_memory) {
    // Beyond the image nothing draws: a force there would not end.
    visit_border(level.dims, [&](size_t voxel) { gradient[voxel] = {}; });
    return {};
  }
  gradient.clear();
  return {ErrorCode::kOutOfMemory, "gradient of " + voxels_text(level.dims) + ": out of memory"};
}

}  // namespace plc
