// An image of any size with a surface of any number of vertices in it: a gyroid cut by a ball.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernels/image.h"

namespace bench {

// Inside of a gyroid of period kPeriod and of a ball, 1/2 on their surface. The gyroid fills space
// evenly: twice the vertices are twice the image, neighbours are as far apart in memory as in any
// large object, and walls are eleven delta apart.
class Potential {
 public:
  static constexpr double kPeriod = 24;  // voxels
  static constexpr float kIso = 0.5F;

  explicit Potential(int64_t vertices) : radius_(radius_for(vertices)) {}

  double radius() const { return radius_; }

  // Sampled every `cell` voxels.
  std::vector<float> sample(double cell) const {
    const int32_t n = dim(cell);
    const auto place = [&](int32_t i) { return cell * (i - (n - 1) / 2.0); };
    std::vector<std::array<double, 2>> wave;  // sine and cosine
    for (int32_t i = 0; i < n; ++i) {
      const double phase = 2 * kPi * place(i) / kPeriod;
      wave.push_back({std::sin(phase), std::cos(phase)});
    }
    std::vector<float> values;
    values.reserve(static_cast<size_t>(n) * static_cast<size_t>(n) * static_cast<size_t>(n));
    for (int32_t z = 0; z < n; ++z) {
      for (int32_t y = 0; y < n; ++y) {
        for (int32_t x = 0; x < n; ++x) {
          const auto &a = wave[at(x)], &b = wave[at(y)], &c = wave[at(z)];
          const double gyroid = a[0] * b[1] + b[0] * c[1] + c[0] * a[1];
          const double r = std::hypot(place(x), place(y), place(z));
          const double value = 0.5 + std::min(kSlope * gyroid, (radius_ - r) / 12);
          values.push_back(static_cast<float>(std::fmin(std::fmax(value, 0), 1)));
        }
      }
    }
    return values;
  }

  // Of what sample() returned; mesh space is in voxels from the centre.
  plc::ImageView view(const std::vector<float>& values, double cell) const {
    plc::ImageView v;
    v.data = values.data();
    for (int a = 0; a < 3; ++a) {
      v.dims[a] = dim(cell);
      v.scale[a] = static_cast<float>(1 / cell);
      v.offset[a] = static_cast<float>((dim(cell) - 1) / 2.0);
    }
    return v;
  }

 private:
  static constexpr double kPi = 3.14159265358979323846;
  static constexpr double kSlope = 0.35;
  static constexpr double kAreaPerVertex = 1.74;  // voxels, once the edges satisfy (1) and (2)

  static size_t at(int32_t i) { return static_cast<size_t>(i); }
  int32_t dim(double cell) const {
    return static_cast<int32_t>(std::ceil(2 * (radius_ + 8) / cell)) + 1;
  }

  // A gyroid has an area of 3.09 per period; half of the ball's is cut off by it.
  static double radius_for(int64_t vertices) {
    const double area = kAreaPerVertex * static_cast<double>(vertices);
    double low = 0, high = 1e5;
    for (int i = 0; i < 60; ++i) {
      const double r = (low + high) / 2;
      const double has = 3.09 / kPeriod * 4 / 3 * kPi * r * r * r + 2 * kPi * r * r;
      (has < area ? low : high) = r;
    }
    return low;
  }

  double radius_;
};

}  // namespace bench
