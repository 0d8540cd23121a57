// Scalar twins of kernels/image_force.h, gradient_force.h, voxels.h and separable.h.
#include <cmath>
#include <limits>

#include "kernels/scalar.h"

namespace plc::kernels::scalar {

namespace {

// The cell of a coordinate and the place in it. NaN and everything below the image give voxel 0,
// everything above it the far end of the last cell.
struct Cell {
  int32_t index;
  float fraction;
};

Cell locate(float p, float scale, float offset, int32_t dim) {
  const float last = static_cast<float>(dim - 1);
  float c = scale * p + offset;
  c = c > 0.0F ? c : 0.0F;
  c = c < last ? c : last;
  int32_t index = static_cast<int32_t>(c);
  index = index < dim - 2 ? index : dim - 2;
  return {index, c - static_cast<float>(index)};
}

// The first voxel of a position's cell, the steps to the next row and plane, the place in the cell.
struct Place {
  int32_t cell, row, plane;
  float x, y, z;
};

template <typename View>
Place locate(const View& image, const Packed& p) {
  const Cell x = locate(p.x, image.scale[0], image.offset[0], image.dims[0]);
  const Cell y = locate(p.y, image.scale[1], image.offset[1], image.dims[1]);
  const Cell z = locate(p.z, image.scale[2], image.offset[2], image.dims[2]);
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

float sample(const ImageView& image, const Packed& p) {
  return trilinear(locate(image, p), [&](int32_t voxel) { return image.data[voxel]; });
}

Triple sample(const GradientView& gradient, const Packed& p) {
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

void sample_trilinear(const ImageView& image, const Packed* position, uint32_t begin, uint32_t end,
                      float* values) {
  for (uint32_t i = begin; i < end; ++i) values[i] = sample(image, position[i]);
}

void iso_force(const ImageView& image, const Packed* position, const float* nx, const float* ny,
               const float* nz, float coefficient, float iso, uint32_t begin, uint32_t end,
               float* fx, float* fy, float* fz) {
  for (uint32_t i = begin; i < end; ++i) {
    const float push = coefficient * (iso - sample(image, position[i]));
    fx[i] += push * nx[i];
    fy[i] += push * ny[i];
    fz[i] += push * nz[i];
  }
}

void gradient_force(const GradientView& gradient, const Packed* position, const float* nx,
                    const float* ny, const float* nz, float along_normal, float along_tangent,
                    const std::array<float, 3>& map, uint32_t begin, uint32_t end, float* fx,
                    float* fy, float* fz) {
  for (uint32_t i = begin; i < end; ++i) {
    const Triple g = sample(gradient, position[i]);
    const float along = g.x * nx[i] + g.y * ny[i] + g.z * nz[i];
    const auto pull = [&](float own, float normal) {
      const float normal_part = normal * along;
      return normal_part * along_normal + (own - normal_part) * along_tangent;
    };
    fx[i] += pull(g.x, nx[i]) * map[0];
    fy[i] += pull(g.y, ny[i]) * map[1];
    fz[i] += pull(g.z, nz[i]) * map[2];
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

void reduce_x(const TapsView& taps, size_t outputs, const float* in, size_t /*width*/,
              size_t in_stride, size_t rows, float* out, size_t out_stride, float* /*scratch*/) {
  for (size_t r = 0; r < rows; ++r) {
    for (size_t i = 0; i < outputs; ++i) {
      out[r * out_stride + i] = weighted_sum(taps.weights + i * static_cast<size_t>(taps.taps),
                                             taps.taps, in + r * in_stride + taps.first[i], 1);
    }
  }
}

void reduce_y(const TapsView& taps, size_t begin, size_t end, const float* in, size_t in_stride,
              size_t width, float* out, size_t out_stride) {
  for (size_t j = begin; j < end; ++j) {
    const float* row = in + static_cast<size_t>(taps.first[j] - taps.first[begin]) * in_stride;
    const float* weights = taps.weights + j * static_cast<size_t>(taps.taps);
    for (size_t i = 0; i < width; ++i) {
      out[(j - begin) * out_stride + i] = weighted_sum(weights, taps.taps, row + i, in_stride);
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
