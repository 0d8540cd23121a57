#include "pyramid/pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <string>
#include <utility>

#include "pyramid/base_image.h"
#include "pyramid/brick_cache.h"
#include "pyramid/check_volume.h"
#include "pyramid/reduced_bricks.h"
#include "pyramid/reduction.h"
#include "pyramid/taps.h"

namespace plc {

namespace {

int64_t reduced(int64_t dim, double reduction) {
  return static_cast<int64_t>(std::floor(static_cast<double>(dim) / reduction));
}

Status check_spec(const PyramidSpec& spec) {
  if (!(spec.reduction > 1.0 && spec.reduction <= 2.0)) {
    return {ErrorCode::kInvalidArgument,
            "reduction " + number_text(spec.reduction) + ": expected more than 1 and at most 2"};
  }
  if (spec.levels < 0) {
    return {ErrorCode::kInvalidArgument,
            "levels " + std::to_string(spec.levels) + ": expected 0 or more"};
  }
  const double width = spec.window_high - spec.window_low;
  if (!(width > 0.0) || !std::isfinite(width) || !std::isfinite(1.0 / width)) {
    return {ErrorCode::kInvalidArgument,
            "window " + number_text(spec.window_low) + " .. " + number_text(spec.window_high) +
                ": expected finite values, the first below the second"};
  }
  if (!std::isfinite(spec.pad_value)) {
    return {ErrorCode::kInvalidArgument,
            "pad value " + number_text(spec.pad_value) + ": expected a finite value"};
  }
  if (spec.pad_voxels < 0) {
    return {ErrorCode::kInvalidArgument,
            "padding of " + std::to_string(spec.pad_voxels) + " voxels: expected 0 or more"};
  }
  return {};
}

Status check_depth(const std::array<int64_t, 3>& padded, const PyramidSpec& spec) {
  const int most = max_levels(padded, spec.reduction);
  if (spec.levels <= most) return {};
  return {ErrorCode::kInvalidArgument, "levels " + std::to_string(spec.levels) +
                                           ": too deep for an image of " + voxels_text(padded) +
                                           " at reduction " + number_text(spec.reduction, 3) +
                                           "; at most " + std::to_string(most)};
}

Window window_of(const PyramidSpec& spec) {
  return {spec.window_low, spec.window_high};
}

Status check_floats(int level, const std::array<int64_t, 3>& dims) {
  if (dims[0] * dims[1] * dims[2] < kMaxVoxels) return {};
  return {ErrorCode::kInvalidData, "level " + std::to_string(level) + " of " + voxels_text(dims) +
                                       ": expected fewer than 2^31, as they are floats; cut the "
                                       "image, or reduce more"};
}

// I_0 is read as it is; the levels above it are floats only where they fit.
Status check_bricks(const VolumeView& volume, const PyramidSpec& spec) {
  const VoxelForm form = borrowed_form(volume, window_of(spec), spec.pad_voxels, spec.pad_value);
  if (form.type != ImageType::kUnit) return {};
  return {ErrorCode::kInvalidArgument,
          "volume of bricks: of 32-bit integers, or with a window beyond the range of floats; such "
          "voxels are needed in memory"};
}

// The levels whose voxels are floats: all but a borrowed I_0.
Status check_levels(const VolumeView& volume, const PyramidSpec& spec) {
  if (volume.bricks != nullptr) return check_bricks(volume, spec);
  std::array<int64_t, 3> dims = padded_dims(volume.dims, spec.pad_voxels);
  const VoxelForm form = borrowed_form(volume, window_of(spec), spec.pad_voxels, spec.pad_value);
  for (int h = 0; h <= spec.levels; ++h) {
    if (h > 0 || form.type == ImageType::kUnit) {
      if (Status s = check_floats(h, dims); !s.ok()) return s;
    }
    for (int64_t& dim : dims) dim = reduced(dim, spec.reduction);
  }
  return {};
}

// Sizes and units of (11); the real size mu x nu x pi is that of I_0 at all levels.
PyramidLevel next_level(const PyramidLevel& level, double reduction) {
  PyramidLevel next;
  next.unit = reduction * level.unit;
  for (size_t axis = 0; axis < 3; ++axis) {
    next.dims[axis] = reduced(level.dims[axis], reduction);
    next.voxel[axis] = level.voxel[axis] * static_cast<double>(level.dims[axis]) /
                       static_cast<double>(next.dims[axis]);
  }
  return next;
}

size_t voxels_of(const PyramidLevel& level) {
  return static_cast<size_t>(level.dims[0] * level.dims[1] * level.dims[2]);
}

// The first level that is built whole.
int first_whole(const VolumeView& volume, const PyramidSpec& spec) {
  if (volume.bricks == nullptr) return 0;
  if (spec.sparse) return spec.levels + 1;
  std::vector<int64_t> voxels;
  std::array<int64_t, 3> dims = padded_dims(volume.dims, spec.pad_voxels);
  for (int h = 0; h <= spec.levels; ++h) {
    voxels.push_back(dims[0] * dims[1] * dims[2]);
    for (int64_t& dim : dims) dim = reduced(dim, spec.reduction);
  }
  const auto most = volume.bricks->cache()->limit() / static_cast<int64_t>(sizeof(float));
  int first = spec.levels + 1;
  for (int64_t sum = 0; first > 1; --first) {
    const int64_t more = voxels[static_cast<size_t>(first) - 1];
    sum += more;
    if (sum > most || more >= kMaxVoxels) break;
  }
  return first;
}

// False when memory ran out.
bool fill_level(const PyramidLevel& from, bool whole, const Executor& executor, PyramidLevel& to) {
  std::array<AxisTaps, 3> taps;
  for (size_t axis = 0; axis < 3; ++axis) {
    // floor() makes voxels larger than rho^h, never smaller: U_h is at most one voxel.
    const double spread = std::min(1.0, from.unit / from.voxel[axis]);
    taps[axis] = make_axis_taps(from.dims[axis], to.dims[axis], spread);
  }
  if (!whole) {
    to.reduced = std::make_shared<ReducedBricks>(level_image(from), from.bricks, std::move(taps),
                                                 to.dims, executor.simd());
    to.bricks = to.reduced;
    to.form.type = ImageType::kF32;  // from 0 to 1: the values themselves
    return true;
  }
  to.values.resize_uninitialized(voxels_of(to));
  return reduce_image(level_image(from), taps, to.dims, executor, to.values.data());
}

void fill_base(const VolumeView& volume, const PyramidSpec& spec, const Executor& executor,
               PyramidLevel& base) {
  const Window window = window_of(spec);
  base.form = borrowed_form(volume, window, spec.pad_voxels, spec.pad_value);
  if (base.form.type != ImageType::kUnit) {
    base.borrowed = volume.voxels;
    base.bricks = volume.bricks;
    return;
  }
  base.form =
      converted_form(volume, window, spec.pad_voxels, spec.pad_value, executor, base.values);
  if (base.form.type != ImageType::kUnit) return;
  base.values.resize_uninitialized(voxels_of(base));
  make_base_image(volume, window, spec.pad_voxels, spec.pad_value, executor, base.values.data());
}

Status out_of_memory(const PyramidSpec& spec) {
  return {ErrorCode::kOutOfMemory,
          "pyramid of " + std::to_string(spec.levels + 1) + " levels: out of memory"};
}

Status build_levels(const VolumeView& volume, const PyramidSpec& spec, const Executor& executor,
                    Pyramid& pyramid) {
  try {
    pyramid.levels.reserve(static_cast<size_t>(spec.levels) + 1);
    PyramidLevel base;
    base.dims = padded_dims(volume.dims, spec.pad_voxels);
    base.voxel = volume.spacing;
    base.unit = *std::min_element(volume.spacing.begin(), volume.spacing.end());
    fill_base(volume, spec, executor, base);
    pyramid.levels.push_back(std::move(base));
    const int whole = first_whole(volume, spec);
    for (int h = 0; h < spec.levels; ++h) {
      PyramidLevel next = next_level(pyramid.levels.back(), spec.reduction);
      if (!fill_level(pyramid.levels.back(), h + 1 >= whole, executor, next)) {
        return out_of_memory(spec);
      }
      pyramid.levels.push_back(std::move(next));
    }
  } catch (const std::bad_alloc&) {
    return out_of_memory(spec);
  }
  return {};
}

}  // namespace

ImageView level_image(const PyramidLevel& level) {
  ImageView image;
  image.data = level.values.empty() ? level.borrowed : level.values.data();
  image.bricks = level.bricks.get();
  image.form = level.form;
  for (size_t a = 0; a < 3; ++a) image.dims[a] = static_cast<int32_t>(level.dims[a]);
  return image;
}

float base_value(const VolumeView& volume, const PyramidSpec& spec, double value) {
  return window_value(volume, window_of(spec), value);
}

Pyramid without_values(const Pyramid& pyramid) {
  Pyramid result;
  for (const PyramidLevel& level : pyramid.levels) {
    result.levels.push_back({level.dims, level.voxel, level.unit, {}, nullptr, {}});
  }
  return result;
}

int max_levels(const std::array<int64_t, 3>& padded_dims, double reduction) {
  if (!(reduction > 1.0 && reduction <= 2.0)) return 0;
  int64_t dim = *std::min_element(padded_dims.begin(), padded_dims.end());  // floor is monotonic
  int levels = 0;
  for (dim = reduced(dim, reduction); dim >= kMinLevelDim; dim = reduced(dim, reduction)) ++levels;
  return levels;
}

std::array<int64_t, 3> padded_dims(const std::array<int64_t, 3>& dims, int pad_voxels) {
  std::array<int64_t, 3> padded = dims;
  for (int64_t& dim : padded) dim += 2 * int64_t{pad_voxels};
  return padded;
}

Status check_padded(const VolumeView& volume, int pad_voxels) {
  const std::array<int64_t, 3> padded = padded_dims(volume.dims, pad_voxels);
  if (!is_volume_size(padded)) {
    return {ErrorCode::kInvalidData, "image of " + voxels_text(padded) + " with its padding of " +
                                         std::to_string(pad_voxels) +
                                         ": expected fewer than 2^31 in a plane, fewer than 2^40 "
                                         "in all"};
  }
  if (volume.type == VoxelType::kI32) return check_floats(0, padded);
  return {};
}

Status build_pyramid(const VolumeView& volume, const PyramidSpec& spec, const Executor& executor,
                     Pyramid& pyramid) {
  pyramid.levels.clear();
  Status status = check_volume(volume);
  if (status.ok()) status = check_spec(spec);
  if (!status.ok()) return status;
  status = check_padded(volume, spec.pad_voxels);
  if (status.ok()) status = check_depth(padded_dims(volume.dims, spec.pad_voxels), spec);
  if (status.ok()) status = check_levels(volume, spec);
  if (status.ok()) status = build_levels(volume, spec, executor, pyramid);
  if (!status.ok()) pyramid.levels.clear();
  return status;
}

}  // namespace plc
