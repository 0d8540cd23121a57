// Scalar twins of kernels/image_force.h, image_rows.h, blend_rows.h, gradient_force.h, voxels.h and
// separable.h.
#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/image_value.h"
#include "kernels/scalar.h"

namespace plc::kernels::scalar {

namespace {

// The first voxel of a position's cell, the steps to the next row and plane, the place in the cell.
struct Place {
  int32_t cell, row, plane;
  float x, y, z;
};

Place locate(const GradientView& image, const Float4& p) {
  const AxisCell x = axis_cell(p.x, image.scale[0], image.offset[0], image.dims[0]);
  const AxisCell y = axis_cell(p.y, image.scale[1], image.offset[1], image.dims[1]);
  const AxisCell z = axis_cell(p.z, image.scale[2], image.offset[2], image.dims[2]);
  const int32_t row = image.dims[0];
  const int32_t plane = image.dims[0] * image.dims[1];
  const int32_t cell = x.index + y.index * row + z.index * plane;
  return {cell, row, plane, x.fraction, y.fraction, z.fraction};
}

float lerp(float a, float b, float t) {
  return a + (b - a) * t;
}

// value(i) at the eight voxels of the cell: along x, then y, then z.
template <typename Value>
float trilinear(const Place& at, const Value& value) {
  const auto along_x = [&](int32_t voxel) { return lerp(value(voxel), value(voxel + 1), at.x); };
  const auto in_plane = [&](int32_t voxel) {
    return lerp(along_x(voxel), along_x(voxel + at.row), at.y);
  };
  return lerp(in_plane(at.cell), in_plane(at.cell + at.plane), at.z);
}

// value(i, j, k) at the corners of a cell, 0 or 1 along each axis: along x, then y, then z.
template <typename Value>
float trilinear(const AxisCell& x, const AxisCell& y, const AxisCell& z, const Value& value) {
  const auto along_x = [&](int32_t j, int32_t k) {
    return lerp(value(0, j, k), value(1, j, k), x.fraction);
  };
  const auto in_plane = [&](int32_t k) { return lerp(along_x(0, k), along_x(1, k), y.fraction); };
  return lerp(in_plane(0), in_plane(1), z.fraction);
}

float within_window(float value) {
  return std::min(std::max(value, 0.0F), 1.0F);
}

template <class Voxel>
float sample(const ImageView& image, const Float4& p) {
  const AxisCell x = axis_cell(p.x, image.scale[0], image.offset[0], image.dims[0]);
  const AxisCell y = axis_cell(p.y, image.scale[1], image.offset[1], image.dims[1]);
  const AxisCell z = axis_cell(p.z, image.scale[2], image.offset[2], image.dims[2]);
  constexpr bool kUnit = std::is_same_v<Voxel, UnitVoxel>;
  const int32_t pad = kUnit ? 0 : image.form.pad;
  const auto stored = [&](const AxisCell& c, int32_t dim) {
    return c.index >= pad && c.index < dim - pad - 1;
  };
  if (!kUnit && (image.bricks != nullptr || !stored(x, image.dims[0]) ||
                 !stored(y, image.dims[1]) || !stored(z, image.dims[2]))) {
    return within_window(trilinear(x, y, z, [&](int32_t i, int32_t j, int32_t k) {
      return image_value<Voxel>(image, x.index + i, y.index + j, z.index + k);
    }));
  }
  const auto row = static_cast<ptrdiff_t>(image.dims[0] - 2 * pad);
  const ptrdiff_t plane = row * (image.dims[1] - 2 * pad);
  const Voxel* cell = static_cast<const Voxel*>(image.data) + (x.index - pad) +
                      (y.index - pad) * row + (z.index - pad) * plane;
  return within_window(trilinear(x, y, z, [&](int32_t i, int32_t j, int32_t k) {
    return voxel_value(image.form, cell[i + j * row + k * plane]);
  }));
}

Triple sample(const GradientView& gradient, const Float4& p) {
  const Place at = locate(gradient, p);
  return {trilinear(at, [&](int32_t voxel) { return gradient.data[voxel].x; }),
          trilinear(at, [&](int32_t voxel) { return gradient.data[voxel].y; }),
          trilinear(at, [&](int32_t voxel) { return gradient.data[voxel].z; })};
}

template <typename T>
void normalize(const T* voxels, size_t count, double low, double scale, float* values) {
  for (size_t i = 0; i < count; ++i) {
    double t = (static_cast<double>(voxels[i]) - low) * scale;
    t = t > 0.0 ? t : 0.0;
    t = t < 1.0 ? t : 1.0;
    values[i] = static_cast<float>(t);
  }
}

template <typename T>
VoxelExtent extent(const T* voxels, size_t count) {
  VoxelExtent result;
  T low = std::numeric_limits<T>::max();
  T high = std::numeric_limits<T>::lowest();
  for (size_t i = 0; i < count; ++i) {
    if constexpr (std::numeric_limits<T>::has_infinity) {
      if (!std::isfinite(voxels[i])) {
        ++result.not_finite;
        continue;
      }
    }
    low = voxels[i] < low ? voxels[i] : low;
    high = voxels[i] > high ? voxels[i] : high;
  }
  if (count != result.not_finite) {
    result.low = static_cast<double>(low) + 0.0;  // -0 becomes 0
    result.high = static_cast<double>(high) + 0.0;
  }
  return result;
}

float weighted_sum(const float* weights, int32_t taps, const float* in, size_t step) {
  float sum = weights[0] * in[0];
  for (int32_t k = 1; k < taps; ++k) sum += weights[k] * in[static_cast<size_t>(k) * step];
  return sum;
}

}  // namespace

void sample_trilinear(const ImageView& image, const Float4* position, uint32_t begin, uint32_t end,
                      float* values) {
  with_voxel_type(image.form.type, [&](auto voxel) {
    for (uint32_t i = begin; i < end; ++i) values[i] = sample<decltype(voxel)>(image, position[i]);
  });
}

void iso_force(const ImageView& image, const Float4* position, ConstFloat3s normal,
               const IsoPull& pull, uint32_t begin, uint32_t end, Float3s force) {
  with_voxel_type(image.form.type, [&](auto voxel) {
    for (uint32_t i = begin; i < end; ++i) {
      const float push =
          pull.coefficient * (pull.iso - sample<decltype(voxel)>(image, position[i]));
      force.x[i] += push * normal.x[i];
      force.y[i] += push * normal.y[i];
      force.z[i] += push * normal.z[i];
    }
  });
}

void image_rows(const ImageView& image, int64_t z, int64_t first, int64_t end, float* values) {
  for (int64_t y = first; y < end; ++y, values += image.dims[0]) image_row(image, y, z, values);
}

void blend_rows(const std::array<const float*, 4>& rows, float y, float z, size_t begin, size_t end,
                float* out) {
  for (size_t i = begin; i < end; ++i) {
    out[i] = lerp(lerp(rows[0][i], rows[1][i], y), lerp(rows[2][i], rows[3][i], y), z);
  }
}

void gradient_force(const GradientView& gradient, const Float4* position, ConstFloat3s normal,
                    const GradientPull& pull, uint32_t begin, uint32_t end, Float3s force) {
  for (uint32_t i = begin; i < end; ++i) {
    const Triple g = sample(gradient, position[i]);
    const float along = g.x * normal.x[i] + g.y * normal.y[i] + g.z * normal.z[i];
    const auto pulled = [&](float own, float n) {
      const float normal_part = n * along;
      return normal_part * pull.along_normal + (own - normal_part) * pull.along_tangent;
    };
    force.x[i] += pulled(g.x, normal.x[i]) * pull.map[0];
    force.y[i] += pulled(g.y, normal.y[i]) * pull.map[1];
    force.z[i] += pulled(g.z, normal.z[i]) * pull.map[2];
  }
}

void normalize_voxels(VoxelType type, const void* voxels, size_t count, double low, double scale,
                      float* values) {
  switch (type) {
    case VoxelType::kU8:
      return normalize(static_cast<const uint8_t*>(voxels), count, low, scale, values);
    case VoxelType::kI16:
      return normalize(static_cast<const int16_t*>(voxels), count, low, scale, values);
    case VoxelType::kU16:
      return normalize(static_cast<const uint16_t*>(voxels), count, low, scale, values);
    case VoxelType::kI32:
      return normalize(static_cast<const int32_t*>(voxels), count, low, scale, values);
    case VoxelType::kF32:
      return normalize(static_cast<const float*>(voxels), count, low, scale, values);
  }
}

VoxelExtent voxel_extent(VoxelType type, const void* voxels, size_t count) {
  switch (type) {
    case VoxelType::kU8:
      return extent(static_cast<const uint8_t*>(voxels), count);
    case VoxelType::kI16:
      return extent(static_cast<const int16_t*>(voxels), count);
    case VoxelType::kU16:
      return extent(static_cast<const uint16_t*>(voxels), count);
    case VoxelType::kI32:
      return extent(static_cast<const int32_t*>(voxels), count);
    case VoxelType::kF32:
      return extent(static_cast<const float*>(voxels), count);
  }
  return {};
}

void reduce_x(const TapsView& taps, const ConstRows& in, size_t rows, const Rows& out,
              float* /*scratch*/) {
  for (size_t r = 0; r < rows; ++r) {
    for (size_t i = 0; i < out.width; ++i) {
      out.values[r * out.stride + i] =
          weighted_sum(taps.weights + i * static_cast<size_t>(taps.taps), taps.taps,
                       in.values + r * in.stride + taps.first[i], 1);
    }
  }
}

void reduce_y(const TapsView& taps, size_t begin, size_t end, const ConstRows& in,
              const Rows& out) {
  for (size_t j = begin; j < end; ++j) {
    const float* row =
        in.values + static_cast<size_t>(taps.first[j] - taps.first[begin]) * in.stride;
    const float* weights = taps.weights + j * static_cast<size_t>(taps.taps);
    for (size_t i = 0; i < in.width; ++i) {
      out.values[(j - begin) * out.stride + i] =
          weighted_sum(weights, taps.taps, row + i, in.stride);
    }
  }
}

void reduce_z(const float* weights, int32_t taps, const float* const* planes, size_t count,
              float* out) {
  for (size_t i = 0; i < count; ++i) {
    float sum = weights[0] * planes[0][i];
    for (int32_t k = 1; k < taps; ++k) sum += weights[k] * planes[k][i];
    out[i] = sum < 1.0F ? sum : 1.0F;
  }
}

}  // namespace plc::kernels::scalar
