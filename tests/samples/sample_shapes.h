// Meshes of smooth shapes at several resolutions, and how their errors shrink.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pyramid/executor.h"
#include "tests/samples/sample_meshes.h"

namespace samples {

inline constexpr double kPi = 3.14159265358979323846;

// Tasks from the last to the first.
class ReverseExecutor final : public plc::Executor {
 public:
  void run(size_t tasks, const std::function<void(size_t)>& body) const override {
    for (size_t i = tasks; i-- > 0;) body(i);
  }
};

// To compare bit by bit, NaN with NaN too.
template <typename T>
std::string bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// The order of convergence: the slope of log(error) over log(size), by least squares.
inline double order_of(const std::vector<double>& sizes, const std::vector<double>& errors) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(sizes.size());
  for (size_t i = 0; i < sizes.size(); ++i) {
    const double x = std::log(sizes[i]), y = std::log(errors[i]);
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

// sphere(levels) with half-axes a, b and c.
inline Soup ellipsoid(int levels, double a, double b, double c) {
  Soup m = sphere(levels);
  for (size_t i = 0; i < m.xyz.size(); i += 3) {
    m.xyz[i] *= a;
    m.xyz[i + 1] *= b;
    m.xyz[i + 2] *= c;
  }
  return m;
}

// Turned by the quaternion 0.5 + 0.5 i + 0.1 j + 0.7 k: about no axis of the coordinates.
inline std::array<std::array<double, 3>, 3> turn() {
  const double w = 0.5, x = 0.5, y = 0.1, z = 0.7;  // of norm 1
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

inline Soup turned(Soup m) {
  const auto r = turn();
  for (size_t i = 0; i < m.xyz.size(); i += 3) {
    const std::array<double, 3> p = {m.xyz[i], m.xyz[i + 1], m.xyz[i + 2]};
    for (size_t k = 0; k < 3; ++k) {
      m.xyz[i + k] = r[k][0] * p[0] + r[k][1] * p[1] + r[k][2] * p[2];
    }
  }
  return m;
}

// n x n squares of [0, 1]^2 at height z, each cut along one diagonal, facing up.
inline Soup sheet(uint32_t n, double z) {
  Soup m;
  for (uint32_t j = 0; j <= n; ++j) {
    for (uint32_t i = 0; i <= n; ++i) m.vertex(double(i) / n, double(j) / n, z);
  }
  for (uint32_t j = 0; j < n; ++j) {
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      m.face(a, b, c);
      m.face(a, c, d);
    }
  }
  return m;
}

}  // namespace samples
