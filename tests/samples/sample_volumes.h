// Small test images, computed: the same bits on every machine, only + - * / and square roots.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pyramid/volume.h"

namespace samples {

// Splitmix64: the tests' own generator, so that a seed means the same everywhere.
class Random {
 public:
  // Mixed: the states of successive seeds would be those of one sequence.
  explicit Random(uint64_t seed) : state_(mixed(seed + 1)) {}
  uint64_t bits() { return mixed(state_ += 0x9E3779B97F4A7C15ULL); }
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) / 9007199254740992.0);
  }
  // Both ends included.
  int64_t integer(int64_t low, int64_t high) {
    return low + static_cast<int64_t>(bits() % static_cast<uint64_t>(high - low + 1));
  }
  template <typename T, size_t kCount>
  T one_of(const T (&choices)[kCount]) {
    return choices[integer(0, kCount - 1)];
  }

 private:
  static uint64_t mixed(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  uint64_t state_;
};

struct Volume {
  std::array<int64_t, 3> dims{};
  std::array<double, 3> spacing{1, 1, 1};
  std::vector<float> values;  // about [0,1], x fastest

  plc::VolumeView view() const { return {plc::VoxelType::kF32, values.data(), dims, spacing}; }
  // The extent in mm, and the smallest of its sides.
  std::array<double, 3> extent() const {
    std::array<double, 3> mm{};
    for (size_t a = 0; a < 3; ++a) mm[a] = static_cast<double>(dims[a]) * spacing[a];
    return mm;
  }
  double smallest() const {
    const auto mm = extent();
    return std::min({mm[0], mm[1], mm[2]});
  }
};

using Point = std::array<double, 3>;

// value(p) at the centre of every voxel, in mm relative to the middle of the image.
template <typename Value>
Volume sampled(Volume v, const Value& value) {
  v.values.clear();
  const auto mm = v.extent();
  for (int64_t z = 0; z < v.dims[2]; ++z) {
    for (int64_t y = 0; y < v.dims[1]; ++y) {
      for (int64_t x = 0; x < v.dims[0]; ++x) {
        const std::array<int64_t, 3> at{x, y, z};
        Point p{};
        for (size_t a = 0; a < 3; ++a) {
          p[a] = (static_cast<double>(at[a]) + 0.5) * v.spacing[a] - mm[a] / 2;
        }
        v.values.push_back(static_cast<float>(value(p)));
      }
    }
  }
  return v;
}

inline Volume empty_volume(std::array<int64_t, 3> dims, std::array<double, 3> spacing = {1, 1, 1}) {
  return {dims, spacing, {}};
}

inline double norm(double x, double y, double z) {
  return std::sqrt(x * x + y * y + z * z);
}

// 1/2 at `part` of the smallest extent from the middle, falling linearly to 0 at twice that.
inline Volume sphere_potential(const Volume& shape, double part = 0.3) {
  const double radius = part * shape.smallest();
  return sampled(shape, [&](const Point& p) {
    return std::max(0.0, 1 - norm(p[0], p[1], p[2]) / (2 * radius));
  });
}

// The chain of 3.9: max(0, 1 - d / (2 r)) at distance d from the nearer of two linked circles of
// radius 14/64 of the smallest extent, r = 3.57/64; 1/2 lies on two tori.
inline Volume chain_potential(const Volume& shape) {
  const double unit = shape.smallest() / 64;
  return sampled(shape, [&](const Point& p) {
    const auto distance = [&](double across, double along, double other) {
      const double radial = std::sqrt(across * across + along * along) - 14 * unit;
      return std::sqrt(radial * radial + other * other);
    };
    const double one = distance(p[0] + 7 * unit, p[1], p[2]);
    const double two = distance(p[0] - 7 * unit, p[2], p[1]);
    return std::max(0.0, 1 - std::min(one, two) / (2 * 3.57 * unit));
  });
}

// The Menger sponge of 5.1, 0 and 1, side 3^depth.
inline Volume menger(int depth) {
  int64_t side = 1;
  for (int i = 0; i < depth; ++i) side *= 3;
  Volume v = empty_volume({side, side, side});
  for (int64_t z = 0; z < side; ++z) {
    for (int64_t y = 0; y < side; ++y) {
      for (int64_t x = 0; x < side; ++x) {
        bool solid = true;
        for (int64_t s = 1; s < side; s *= 3) {
          const int middles =
              (x / s % 3 == 1 ? 1 : 0) + (y / s % 3 == 1 ? 1 : 0) + (z / s % 3 == 1 ? 1 : 0);
          solid = solid && middles < 2;
        }
        v.values.push_back(solid ? 1.0F : 0.0F);
      }
    }
  }
  return v;
}

// Random metaballs: the sum of (1 - d^2 / R^2)^2 within balls of radius R, at most 1.
inline Volume blobs(const Volume& shape, int count, uint64_t seed) {
  Random random(seed);
  const auto mm = shape.extent();
  std::vector<std::array<double, 4>> balls;
  for (int i = 0; i < count; ++i) {
    std::array<double, 4> ball{};
    for (size_t a = 0; a < 3; ++a) ball[a] = random.uniform(-0.35, 0.35) * mm[a];
    ball[3] = random.uniform(0.15, 0.35) * shape.smallest();
    balls.push_back(ball);
  }
  return sampled(shape, [&](const Point& p) {
    double sum = 0;
    for (const auto& [x, y, z, radius] : balls) {
      const double d = norm(p[0] - x, p[1] - y, p[2] - z) / radius;
      if (d < 1) sum += (1 - d * d) * (1 - d * d);
    }
    return std::min(1.0, sum);
  });
}

// A spherical shell, 1 on a sphere of 0.36 of the smallest extent, 0 at 0.08 of it on both sides.
inline Volume shell(const Volume& shape) {
  const double unit = shape.smallest();
  return sampled(shape, [&](const Point& p) {
    const double t = (norm(p[0], p[1], p[2]) - 0.36 * unit) / (0.08 * unit);
    return t * t < 1 ? (1 - t * t) * (1 - t * t) : 0.0;
  });
}

// Random values on a lattice of `period` mm, trilinear in between: caverns, bridges and islands.
inline Volume noise(const Volume& shape, double period, uint64_t seed) {
  Random random(seed);
  constexpr size_t kSide = 32;
  std::vector<double> lattice(kSide * kSide * kSide);
  for (double& value : lattice) value = random.uniform(0, 1);
  const auto value_at = [&](size_t x, size_t y, size_t z) {
    return lattice[(z % kSide * kSide + y % kSide) * kSide + x % kSide];
  };
  return sampled(shape, [&](const Point& p) {
    size_t cell[3];
    double f[3];
    for (size_t a = 0; a < 3; ++a) {
      const double at = p[a] / period + 16;
      cell[a] = static_cast<size_t>(at);
      f[a] = at - static_cast<double>(cell[a]);
    }
    double sum = 0;
    for (size_t corner = 0; corner < 8; ++corner) {
      const size_t dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2 & 1;
      const double weight =
          (dx != 0 ? f[0] : 1 - f[0]) * (dy != 0 ? f[1] : 1 - f[1]) * (dz != 0 ? f[2] : 1 - f[2]);
      sum += weight * value_at(cell[0] + dx, cell[1] + dy, cell[2] + dz);
    }
    return sum;
  });
}

// Uniform noise of +- amplitude on every voxel.
inline void add_noise(Volume& v, double amplitude, uint64_t seed) {
  Random random(seed);
  for (float& value : v.values) {
    value = static_cast<float>(static_cast<double>(value) + random.uniform(-amplitude, amplitude));
  }
}

}  // namespace samples
