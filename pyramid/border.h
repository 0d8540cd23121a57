// The border of an image, whose voxels stand for all that lies beyond it: kernels clamp places
// outside to the nearest voxel.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "pyramid/pyramid.h"

namespace plc {

// visit(index) for every voxel with a neighbour outside of the image, once.
template <typename Visit>
void visit_border(const std::array<int64_t, 3>& dims, const Visit& visit) {
  const auto width = static_cast<size_t>(dims[0]);
  for (int64_t z = 0; z < dims[2]; ++z) {
    for (int64_t y = 0; y < dims[1]; ++y) {
      const size_t row = static_cast<size_t>(z * dims[1] + y) * width;
      const bool inside = z > 0 && z + 1 < dims[2] && y > 0 && y + 1 < dims[1];
      for (size_t x = 0; x < width; x += inside && x == 0 && width > 1 ? width - 1 : 1) {
        visit(row + x);
      }
    }
  }
}

// What becomes of a value of the border: what is of the object (at iso or beyond it, seen from
// `outside`, the value around the image) is brought half way back to `outside`. All in [0,1].
class ClosedBorder {
 public:
  ClosedBorder(double iso, double outside)
      : iso_(static_cast<float>(iso)),
        half_way_(static_cast<float>((iso + outside) / 2)),
        below_(outside < iso) {}
  float operator()(float value) const {
    return (below_ ? value >= iso_ : value <= iso_) ? half_way_ : value;
  }

 private:
  float iso_, half_way_;
  bool below_;
};

// Closes the border of a level above I_0. On I_0 the padding is the border; on coarse images it is
// blended with what it surrounds, and a surface that meets the object there would follow it away
// from the image for ever.
void close_border(PyramidLevel& level, double iso, double outside);

}  // namespace plc
