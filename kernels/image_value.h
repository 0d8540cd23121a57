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
    const float low = 0.0F - form.beyond, high = 1.0F + form.beyond;
    float t = (static_cast<float>(voxel) - form.low) * form.scale;
    t = t > low ? t : low;
    return t < high ? t : high;
  }
}

// The first stored voxel of row (y, z), counted in the image; null where the row is padding. Not of
// bricks.
template <class Voxel>
inline const Voxel* stored_row(const ImageView& image, int64_t y, int64_t z) {
  const int64_t pad = image.form.pad;
  const int64_t size[3] = {image.dims[0] - 2 * pad, image.dims[1] - 2 * pad,
                           image.dims[2] - 2 * pad};
  if (y < pad || z < pad || y >= pad + size[1] || z >= pad + size[2]) return nullptr;
  return static_cast<const Voxel*>(image.data) + ((z - pad) * size[1] + y - pad) * size[0];
}

// At voxel (x, y, z), which lies in an image of bricks, within BrickReads.
template <class Voxel>
inline float brick_value(const ImageView& image, int64_t x, int64_t y, int64_t z) {
  if constexpr (std::is_same_v<Voxel, UnitVoxel>) {
    return 0;  // there are none
  } else {
    const int64_t pad = image.form.pad;
    const auto stored = [&](int64_t i, int32_t dim) { return i >= pad && i < dim - pad; };
    if (!stored(x, image.dims[0]) || !stored(y, image.dims[1]) || !stored(z, image.dims[2])) {
      return image.form.pad_value;
    }
    return voxel_value(image.form, image.bricks->voxel<Voxel>(x - pad, y - pad, z - pad));
  }
}

// At voxel (x, y, z), which lies in the image.
template <class Voxel>
inline float image_value(const ImageView& image, int64_t x, int64_t y, int64_t z) {
  if (image.bricks != nullptr) {
    const BrickReads reads(image.bricks);
    return brick_value<Voxel>(image, x, y, z);
  }
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

// visit(stored voxels, x, count): those of first .. end - 1 in row (y, z), pieces one behind the
// other; x counted in the image. What is padding is not visited. Within BrickReads.
template <class Voxel, class Visit>
inline void visit_stored(const ImageView& image, int64_t y, int64_t z, int64_t first, int64_t end,
                         const Visit& visit) {
  const int64_t pad = image.form.pad;
  if (y < pad || z < pad || y >= image.dims[1] - pad || z >= image.dims[2] - pad) return;
  first = std::max(first, pad);
  end = std::min(end, image.dims[0] - pad);
  if (first >= end) return;
  if constexpr (!std::is_same_v<Voxel, UnitVoxel>) {
    if (image.bricks != nullptr) {
      return image.bricks->visit_row<Voxel>(
          y - pad, z - pad, first - pad, end - pad,
          [&](const Voxel* voxels, int64_t x, int64_t count) { visit(voxels, x + pad, count); });
    }
  }
  visit(stored_row<Voxel>(image, y, z) + (first - pad), first, end - first);
}

// values[x - first] = the padding's value where voxel x of row (y, z) is padding, first <= x < end.
inline void fill_padding(const ImageView& image, int64_t y, int64_t z, int64_t first, int64_t end,
                         float* values) {
  const int64_t pad = image.form.pad;
  const bool stored = y >= pad && z >= pad && y < image.dims[1] - pad && z < image.dims[2] - pad;
  const int64_t begin = stored ? std::clamp(pad, first, end) : end;
  const int64_t behind = std::clamp(image.dims[0] - pad, begin, end);
  std::fill_n(values, begin - first, image.form.pad_value);
  std::fill_n(values + (behind - first), end - behind, image.form.pad_value);
}

// values[x - first] = voxel x of row (y, z) of the image, first <= x < end.
template <class Voxel>
inline void image_row(const ImageView& image, int64_t y, int64_t z, int64_t first, int64_t end,
                      float* values) {
  const BrickReads reads(image.bricks);
  fill_padding(image, y, z, first, end, values);
  visit_stored<Voxel>(image, y, z, first, end, [&](const Voxel* voxels, int64_t x, int64_t count) {
    float* to = values + (x - first);
    for (int64_t i = 0; i < count; ++i) {
      to[i] = voxel_value(image.form, voxels[i]);
    }
  });
}
inline void image_row(const ImageView& image, int64_t y, int64_t z, int64_t first, int64_t end,
                      float* values) {
  with_voxel_type(image.form.type,
                  [&](auto voxel) { image_row<decltype(voxel)>(image, y, z, first, end, values); });
}
// The whole row.
inline void image_row(const ImageView& image, int64_t y, int64_t z, float* values) {
  image_row(image, y, z, 0, image.dims[0], values);
}

}  // namespace plc
