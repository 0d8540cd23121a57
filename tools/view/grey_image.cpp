#include "tools/view/grey_image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace plc::tools {

namespace {

constexpr double kCut = 0.0001;      // part of the voxels that the window leaves out at each end
constexpr double kExactRange = 255;  // of integers that 8 bits hold as they are
constexpr size_t kMaxSamples = 1 << 20;

size_t count_of(const std::array<int64_t, 3>& dims) {
  return static_cast<size_t>(dims[0] * dims[1] * dims[2]);
}

template <typename T>
struct Voxels {
  const T* values;
  size_t count;

  // Calls visit(value) for every voxel whose value is finite.
  template <typename Visit>
  void each(const Visit& visit) const {
    for (size_t i = 0; i < count; ++i) {
      const auto value = static_cast<double>(values[i]);
      if (std::isfinite(value)) visit(value);
    }
  }
};

// Percentiles of a million voxels at most: a histogram would be all in one bin where a few voxels
// are far from all others.
template <typename T>
GreyWindow derived_window(const Voxels<T>& voxels, double low, double high) {
  if (!(high > low)) return {low, low + kExactRange};
  if (std::numeric_limits<T>::is_integer && high - low <= kExactRange) {
    return {low, low + kExactRange};
  }
  const size_t stride = voxels.count / kMaxSamples | 1;  // odd: not along one column of the image
  std::vector<double> samples;
  for (size_t i = 0; i < voxels.count; i += stride) {
    const auto value = static_cast<double>(voxels.values[i]);
    if (std::isfinite(value)) samples.push_back(value);
  }
  const auto ranked = [&](double part) {
    const auto rank = std::lround(part * static_cast<double>(samples.size() - 1));
    std::nth_element(samples.begin(), samples.begin() + rank, samples.end());
    return samples[static_cast<size_t>(rank)];
  };
  if (samples.empty()) return {low, high};
  const GreyWindow window = {ranked(kCut), ranked(1 - kCut)};
  return window.high > window.low ? window : GreyWindow{low, high};
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
  std::vector<uint8_t> out(count_of(to.dims));
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

template <typename T>
GreyImage made_of(const plc_image& image, const std::optional<GreyWindow>& window,
                  int64_t max_voxels) {
  const auto* values = static_cast<const T*>(image.voxels);
  const Voxels<T> voxels{values, count_of({image.dims[0], image.dims[1], image.dims[2]})};
  GreyImage grey;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  voxels.each([&](double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  });
  if (low <= high) {
    grey.low = low;
    grey.high = high;
  }
  grey.window = window ? *window : derived_window(voxels, grey.low, grey.high);
  choose_reduction(image, max_voxels, grey);
  grey.voxels = reduced(values, image.dims, grey);
  grey.exact = std::numeric_limits<T>::is_integer && !grey.reduced() && grey.window.step() == 1 &&
               grey.window.low <= grey.low && grey.high <= grey.window.high &&
               grey.window.low == std::floor(grey.window.low);
  return grey;
}

}  // namespace

GreyImage grey_image(const plc_image& image, const std::optional<GreyWindow>& window,
                     int64_t max_voxels) {
  switch (image.type) {
    case PLC_U8:
      return made_of<uint8_t>(image, window, max_voxels);
    case PLC_I16:
      return made_of<int16_t>(image, window, max_voxels);
    case PLC_U16:
      return made_of<uint16_t>(image, window, max_voxels);
    case PLC_I32:
      return made_of<int32_t>(image, window, max_voxels);
    case PLC_F32:
      return made_of<float>(image, window, max_voxels);
  }
  return {};
}

}  // namespace plc::tools
