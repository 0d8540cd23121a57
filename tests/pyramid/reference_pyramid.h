// The pyramid from the volume up, all in double: sizes by (11), centres by (10), values by (12).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace reference {

using Dims = std::array<int64_t, 3>;

struct Level {
  Dims dims;
  std::vector<double> values;
};

// One axis of (10): the place among the `from` voxels of an axis of real size `extent`, in voxels,
// of voxel i of `to`, moved by `shift` of real space.
inline double place_in(int64_t from, int64_t to, double extent, int64_t i, double shift) {
  const double real = (static_cast<double>(i) + 0.5) * extent / static_cast<double>(to) + shift;
  return real * static_cast<double>(from) / extent - 0.5;
}

inline double real_image(const Level& level, const std::array<double, 3>& place) {
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int64_t at[3];
    for (size_t a = 0; a < 3; ++a) {
      const double below = std::floor(place[a]);
      const bool up = (corner >> a & 1) == 1;
      weight *= up ? place[a] - below : 1 - (place[a] - below);
      at[a] = std::clamp<int64_t>(static_cast<int64_t>(below) + (up ? 1 : 0), 0, level.dims[a] - 1);
    }
    sum +=
        weight *
        level.values[static_cast<size_t>(at[0] + level.dims[0] * (at[1] + level.dims[1] * at[2]))];
  }
  return sum;
}

inline Level next_level(const Level& from, const std::array<double, 3>& extent, double reduction,
                        double unit) {
  const double kernel[5] = {1, 4, 6, 4, 1};
  Level to;
  for (size_t a = 0; a < 3; ++a) {
    to.dims[a] = static_cast<int64_t>(std::floor(static_cast<double>(from.dims[a]) / reduction));
  }
  for (int64_t voxel = 0; voxel < to.dims[0] * to.dims[1] * to.dims[2]; ++voxel) {
    const Dims at{voxel % to.dims[0], voxel / to.dims[0] % to.dims[1],
                  voxel / to.dims[0] / to.dims[1]};
    double sum = 0;
    for (int point = 0; point < 125; ++point) {
      const int offset[3] = {point % 5, point / 5 % 5, point / 25};
      std::array<double, 3> place{};
      double weight = 1.0 / 4096;
      for (size_t a = 0; a < 3; ++a) {
        place[a] = place_in(from.dims[a], to.dims[a], extent[a], at[a], (offset[a] - 2) * unit);
        weight *= kernel[offset[a]];
      }
      sum += weight * real_image(from, place);
    }
    to.values.push_back(sum);
  }
  return to;
}

}  // namespace reference
