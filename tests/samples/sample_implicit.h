// Surfaces f = 0 by marching tetrahedra: closed and manifold on any lattice, with f <= 0 inside.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "pyramid/memory.h"
#include "tests/samples/sample_meshes.h"

namespace samples {

using Field = std::function<double(double, double, double)>;

// Over [-extent, extent] in each axis, in cubes of the given size, each cut into six tetrahedra.
// f > 0 on the border. Vertices are on the surface, to rounding.
class MarchingTetrahedra {
 public:
  MarchingTetrahedra(const Field& f, const std::array<double, 3>& extent, double size)
      : f_(f), size_(size) {
    for (size_t a = 0; a < 3; ++a) {
      half_[a] = static_cast<int64_t>(std::ceil(extent[a] / size));
      count_[a] = 2 * half_[a] + 1;
    }
    values_.resize(static_cast<size_t>(count_[0] * count_[1] * count_[2]));
    for (size_t i = 0; i < values_.size(); ++i) {
      const std::array<double, 3> p = position(static_cast<int64_t>(i));
      values_[i] = f(p[0], p[1], p[2]);
    }
  }

  Soup surface() {
    const int64_t step[3] = {1, count_[0], count_[0] * count_[1]};
    constexpr size_t kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                      {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int64_t z = 0; z + 1 < count_[2]; ++z) {
      for (int64_t y = 0; y + 1 < count_[1]; ++y) {
        for (int64_t x = 0; x + 1 < count_[0]; ++x) {
          const int64_t first = x * step[0] + y * step[1] + z * step[2];
          for (const auto& order : kOrders) {
            std::array<int64_t, 4> corner{first};
            for (size_t k = 0; k < 3; ++k) corner[k + 1] = corner[k] + step[order[k]];
            tetrahedron(corner);
          }
        }
      }
    }
    return std::move(mesh_);
  }

 private:
  std::array<double, 3> position(int64_t i) const {
    return {size_ * double(i % count_[0] - half_[0]),
            size_ * double(i / count_[0] % count_[1] - half_[1]),
            size_ * double(i / (count_[0] * count_[1]) - half_[2])};
  }
  bool inside(int64_t i) const { return values_[static_cast<size_t>(i)] <= 0; }

  uint32_t crossing(int64_t in, int64_t out) {
    const uint64_t key = static_cast<uint64_t>(in) * values_.size() + static_cast<uint64_t>(out);
    const auto [it, fresh] = ids_.try_emplace(key, 0U);
    if (fresh) {
      const auto p = position(in), q = position(out);
      double low = 0, high = 1;
      const auto at = [&](double t, size_t k) { return p[k] + t * (q[k] - p[k]); };
      for (int step = 0; step < 50; ++step) {
        const double t = (low + high) / 2;
        (f_(at(t, 0), at(t, 1), at(t, 2)) <= 0 ? low : high) = t;
      }
      it->second = mesh_.vertex(at(low, 0), at(low, 1), at(low, 2));
    }
    return it->second;
  }

  void tetrahedron(const std::array<int64_t, 4>& corner) {
    std::vector<int64_t> in, out;
    for (const int64_t c : corner) (inside(c) ? in : out).push_back(c);
    if (in.empty() || out.empty()) return;
    plc::Vector<uint32_t> polygon;
    if (in.size() == 2) {
      polygon = {crossing(in[0], out[0]), crossing(in[0], out[1]), crossing(in[1], out[1]),
                 crossing(in[1], out[0])};
    } else {
      for (const int64_t i : in) {
        for (const int64_t o : out) polygon.push_back(crossing(i, o));
      }
    }
    const bool turn = faces_inward(in, out);
    for (size_t k = 2; k < polygon.size(); ++k) {
      mesh_.face(polygon[0], polygon[turn ? k : k - 1], polygon[turn ? k - 1 : k]);
    }
  }
  // Of the polygon as if it crossed the edges in their middles.
  bool faces_inward(const std::vector<int64_t>& in, const std::vector<int64_t>& out) const {
    const auto middle = [&](int64_t a, int64_t b) {
      const auto p = position(a), q = position(b);
      return std::array<double, 3>{p[0] + q[0], p[1] + q[1], p[2] + q[2]};
    };
    const auto a = middle(in[0], out[0]);
    const auto b = in.size() == 3 ? middle(in[1], out[0]) : middle(in[0], out[1]);
    const auto c = in.size() == 3   ? middle(in[2], out[0])
                   : in.size() == 2 ? middle(in[1], out[1])
                                    : middle(in[0], out[2]);
    const auto p = position(in[0]), q = position(out[0]);
    const double u[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const double v[3] = {c[0] - a[0], c[1] - a[1], c[2] - a[2]};
    return (u[1] * v[2] - u[2] * v[1]) * (q[0] - p[0]) +
               (u[2] * v[0] - u[0] * v[2]) * (q[1] - p[1]) +
               (u[0] * v[1] - u[1] * v[0]) * (q[2] - p[2]) <
           0;
  }

  Field f_;
  double size_;
  std::array<int64_t, 3> half_{}, count_{};
  std::vector<double> values_;
  std::unordered_map<uint64_t, uint32_t> ids_;
  Soup mesh_;
};

// A tube around a lemniscate: (x^2 (1 - x^2) - y^2)^2 + z^2 = 0.15^2, of genus 2.
inline Soup double_torus(double size) {
  const auto field = [](double x, double y, double z) {
    const double g = x * x * (1 - x * x) - y * y;
    return g * g + z * z - 0.0225;
  };
  return MarchingTetrahedra(field, {1.2, 0.8, 0.25}, size).surface();
}

// Its volume, by the midpoint rule over x and y.
inline double double_torus_volume() {
  constexpr int kX = 3000, kY = 2000;
  double sum = 0;
  for (int j = 0; j < kY; ++j) {
    for (int i = 0; i < kX; ++i) {
      const double x = 1.2 * (i + 0.5) / kX, y = 0.8 * (j + 0.5) / kY;
      const double g = x * x * (1 - x * x) - y * y;
      if (g * g < 0.0225) sum += std::sqrt(0.0225 - g * g);
    }
  }
  return 8 * sum * (1.2 / kX) * (0.8 / kY);
}

}  // namespace samples
