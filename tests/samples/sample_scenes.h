// Images of a few balls, for what looks at images and surfaces together.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernels/image.h"
#include "tests/samples/sample_volumes.h"

namespace samples {

struct Ball {
  double x, y, z, radius;
};

// An image of 40 x 24 x 24 mesh units; 1/2 on the surfaces of balls, larger inside. Voxel i lies at
// i / scale on each axis.
struct BallScene {
  std::array<int32_t, 3> dims{40, 24, 24};
  std::array<float, 3> scale{1, 1, 1};  // voxels per mesh unit
  std::vector<float> values;

  // Balls one after the other: solid, or (radius < 0) hollowed out of what is there.
  explicit BallScene(const std::vector<Ball>& balls, std::array<float, 3> voxels = {1, 1, 1})
      : scale(voxels) {
    for (size_t a = 0; a < 3; ++a) {
      dims[a] = static_cast<int32_t>(static_cast<float>(dims[a]) * scale[a]);
    }
    for (int32_t z = 0; z < dims[2]; ++z) {
      for (int32_t y = 0; y < dims[1]; ++y) {
        for (int32_t x = 0; x < dims[0]; ++x) values.push_back(value(balls, {x, y, z}));
      }
    }
  }
  float& at(int32_t x, int32_t y, int32_t z) {
    return values[static_cast<size_t>((z * dims[1] + y) * dims[0] + x)];
  }
  plc::ImageView view() const {
    plc::ImageView v;
    v.data = values.data();
    for (size_t a = 0; a < 3; ++a) {
      v.dims[a] = dims[a];
      v.scale[a] = scale[a];
    }
    return v;
  }

 private:
  float value(const std::vector<Ball>& balls, const std::array<int32_t, 3>& at) const {
    double best = 0;
    for (const Ball& b : balls) {
      const double depth = std::abs(b.radius) - norm(at[0] / static_cast<double>(scale[0]) - b.x,
                                                     at[1] / static_cast<double>(scale[1]) - b.y,
                                                     at[2] / static_cast<double>(scale[2]) - b.z);
      const double solid = std::clamp(0.5 + 0.25 * depth, 0.0, 1.0);
      best = b.radius > 0 ? std::max(best, solid) : std::min(best, 1 - solid);
    }
    return static_cast<float>(best);
  }
};

}  // namespace samples
