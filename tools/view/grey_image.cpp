#include "tools/view/grey_image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "tools/volume/volume_statistics.h"
#include "tools/volume/voxels.h"

namespace plc::tools {

namespace {

constexpr double kCut = 0.01;  // per cent of the voxels that the window leaves out at each end
constexpr double kExactRange = 255;  // of integers that 8 bits hold as they are

GreyWindow derived_window(const plc_image& image, double low, double high) {
  if (!(high > low)) return {low, low + kExactRange};
  if (image.type != PLC_F32 && high - low <= kExactRange) return {low, low + kExactRange};
  const std::vector<double> cut = percentiles_of(image, {kCut, 100 - kCut});
  return cut[1] > cut[0] ? GreyWindow{cut[0], cut[1]} : GreyWindow{low, high};
}

uint8_t grey(double value, const GreyWindow& window) {
  if (std::isnan(value)) return 0;
  const double x = std::clamp((value - window.low) / window.step(), 0.0, 255.0);
  return static_cast<uint8_t>(std::lround(x));
}

// The mean of each block, row of blocks by row of blocks.
template <typename T>
std::vector<uint8_t> reduced(const T* values, const int64_t from[3], const GreyImage& to) {
  const auto& f = to.reduction;
  std::vector<uint8_t> out(static_cast<size_t>(to.dims[0] * to.dims[1] * to.dims[2]));
  std::vector<double> sums(static_cast<size_t>(to.dims[0]));
  size_t next = 0;
  for (int64_t z = 0; z < to.dims[2]; ++z) {
    for (int64_t y = 0; y < to.dims[1]; ++y) {
      std::fill(sums.begin(), sums.end(), 0);
      const int64_t z_end = std::min((z + 1) * f[2], from[2]);
      const int64_t y_end = std::min((y + 1) * f[1], from[1]);
      for (int64_t zz = z * f[2]; zz < z_end; ++zz) {
        for (int64_t yy = y * f[1]; yy < y_end; ++yy) {
          const T* row = values + (zz * from[1] + yy) * from[0];
          for (int64_t xx = 0; xx < from[0]; ++xx) {
            sums[static_cast<size_t>(xx / f[0])] += static_cast<double>(row[xx]);
          }
        }
      }
      const int64_t rows = (z_end - z * f[2]) * (y_end - y * f[1]);
      for (int64_t x = 0; x < to.dims[0]; ++x) {
        const int64_t columns = std::min((x + 1) * f[0], from[0]) - x * f[0];
        out[next++] =
            grey(sums[static_cast<size_t>(x)] / static_cast<double>(rows * columns), to.window);
      }
    }
  }
  return out;
}

void choose_reduction(const plc_image& image, int64_t max_voxels, GreyImage& grey) {
  const auto update = [&] {
    for (size_t axis = 0; axis < 3; ++axis) {
      grey.dims[axis] = (image.dims[axis] + grey.reduction[axis] - 1) / grey.reduction[axis];
    }
  };
  update();
  while (grey.dims[0] * grey.dims[1] * grey.dims[2] > max_voxels) {
    size_t shortest = 3;
    double length = std::numeric_limits<double>::infinity();
    for (size_t axis = 0; axis < 3; ++axis) {
      const double next = image.spacing[axis] * static_cast<double>(grey.reduction[axis] + 1);
      if (grey.dims[axis] > 2 && next < length) {
        length = next;
        shortest = axis;
      }
    }
    if (shortest == 3) return;
    ++grey.reduction[shortest];
    update();
  }
}

}  // namespace

GreyImage grey_image(const plc_image& image, const std::optional<GreyWindow>& window,
                     int64_t max_voxels) {
  GreyImage grey;
  const VolumeRange range = range_of(image);
  if (range.finite > 0) {
    grey.low = range.low;
    grey.high = range.high;
  }
  grey.window = window ? *window : derived_window(image, grey.low, grey.high);
  choose_reduction(image, max_voxels, grey);
  grey.voxels = with_voxels(image, [&](const auto* first, const auto* /*last*/) {
    return reduced(first, image.dims, grey);
  });
  grey.exact = image.type != PLC_F32 && !grey.reduced() && grey.window.step() == 1 &&
               grey.window.low <= grey.low && grey.high <= grey.window.high &&
               grey.window.low == std::floor(grey.window.low);
  return grey;
}

}  // namespace plc::tools
