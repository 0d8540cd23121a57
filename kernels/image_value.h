// Single values of an image whatever its voxels are: for code that is no kernel, and for the
// scalar twins. The vector kernels do the same operations in the same order.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kernels/image.h"

namespace plc {

// The value of a stored voxel, by VoxelForm.
template <class Voxel>
inline float voxel_value(const VoxelForm& form, Voxel voxel) {
  if constexpr (std::is_same_v<Voxel, UnitVoxel>) {
    return voxel.value;
  } else {
    float t = (static_cast<float>(voxel) - form.low) * form.scale;
    t = t > 0.0F ? t : 0.0F;
    return t < 1.0F ? t : 1.0F;
  }
}

// The first stored voxel of row (y, z), counted in the image; null where the row is padding.
template <class Voxel>
inline const Voxel* stored_row(const ImageView& image, int64_t y, int64_t z) {
  const int64_t pad = image.form.pad;
  const int64_t size[3] = {image.dims[0] - 2 * pad, image.dims[1] - 2 * pad,
                           image.dims[2] - 2 * pad};
  if (y < pad || z < pad || y >= pad + size[1] || z >= pad + size[2]) return nullptr;
  return static_cast<const Voxel*>(image.data) + ((z - pad) * size[1] + y - pad) * size[0];
}

// At voxel (x, y, z), which lies in the image.
template <class Voxel>
inline float image_value(const ImageView& image, int64_t x, int64_t y, int64_t z) {
  const int64_t pad = image.form.pad;
  const Voxel* row = stored_row<Voxel>(image, y, z);
  if (row == nullptr || x < pad || x >= image.dims[0] - pad) return image.form.pad_value;
  return voxel_value(image.form, row[x - pad]);
}
inline float image_value(const ImageView& image, int64_t x, int64_t y, int64_t z) {
  float value = 0;
  with_voxel_type(image.form.type,
                  [&](auto voxel) { value = image_value<decltype(voxel)>(image, x, y, z); });
  return value;
}

// The cell of a coordinate of mesh space on one axis, and the place in it. NaN and everything below
// the image give voxel 0, everything above it the far end of the last cell.
struct AxisCell {
  int32_t index;
  float fraction;
};
inline AxisCell axis_cell(float p, float scale, float offset, int32_t dim) {
  const float last = static_cast<float>(dim - 1);
  float c = scale * p + offset;
  c = c > 0.0F ? c : 0.0F;
  c = c < last ? c : last;
  int32_t index = static_cast<int32_t>(c);
  index = index < dim - 2 ? index : dim - 2;
  return {index, c - static_cast<float>(index)};
}

// values[0 .. dims[0]-1] = row (y, z) of the image.
template <class Voxel>
inline void image_row(const ImageView& image, int64_t y, int64_t z, float* values) {
  const auto width = static_cast<size_t>(image.dims[0]);
  const auto pad = static_cast<size_t>(image.form.pad);
  const Voxel* row = stored_row<Voxel>(image, y, z);
  if (row == nullptr) {
    std::fill_n(values, width, image.form.pad_value);
    return;
  }
  std::fill_n(values, pad, image.form.pad_value);
  for (size_t x = pad; x < width - pad; ++x) values[x] = voxel_value(image.form, row[x - pad]);
  std::fill_n(values + (width - pad), pad, image.form.pad_value);
}
inline void image_row(const ImageView& image, int64_t y, int64_t z, float* values) {
  with_voxel_type(image.form.type,
                  [&](auto voxel) { image_row<decltype(voxel)>(image, y, z, values); });
}

}  // namespace plc
