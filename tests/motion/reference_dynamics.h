// The paper's equations of motion (4)-(8), evaluated directly in double.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/mesh/mesh.h"
#include "engine/motion/dynamics.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace reference {

using plc::Mesh;
using plc::Model;
using plc::RestLength;

using Point = std::array<double, 3>;
using Points = std::vector<Point>;

inline Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point operator-(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Point operator*(const Point& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
inline double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double length(const Point& a) {
  return std::sqrt(dot(a, a));
}
inline double distance(const Point& a, const Point& b) {
  return length(a - b);
}
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Point to_point(plc::Vec3 a) {
  return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

// Grids of 24 voxels a side, their middle at the origin of the mesh, one voxel per mesh unit.
constexpr size_t kSide = 24;
constexpr double kMiddle = 11.5;

template <typename View>
View placed() {
  View v;
  for (size_t a = 0; a < 3; ++a) {
    v.dims[a] = kSide;
    v.offset[a] = static_cast<float>(kMiddle);
  }
  return v;
}

// Trilinear at p, clamped to the grid: visit(voxel, weight) for the eight voxels around it.
template <typename Visit>
void interpolate(const Point& p, const Visit& visit) {
  size_t cell[3];
  double f[3];
  for (size_t a = 0; a < 3; ++a) {
    const double x = std::clamp(p[a] + kMiddle, 0.0, kSide - 1.0);
    cell[a] = std::min(static_cast<size_t>(x), kSide - 2);
    f[a] = x - static_cast<double>(cell[a]);
  }
  for (size_t corner = 0; corner < 8; ++corner) {
    const size_t dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2 & 1;
    const double weight =
        (dx != 0 ? f[0] : 1 - f[0]) * (dy != 0 ? f[1] : 1 - f[1]) * (dz != 0 ? f[2] : 1 - f[2]);
    visit(((cell[2] + dz) * kSide + cell[1] + dy) * kSide + cell[0] + dx, weight);
  }
}

struct Image {
  std::vector<float> values;
  plc::ImageView view() const {
    auto v = placed<plc::ImageView>();
    v.data = values.data();
    return v;
  }
  double at(const Point& p) const {
    double sum = 0;
    interpolate(p,
                [&](size_t i, double weight) { sum += weight * static_cast<double>(values[i]); });
    return sum;
  }
};

// Pi_gradI of (8): vectors in the lengths of the forces.
struct Gradient {
  std::vector<plc::Float4> vectors;
  plc::GradientView view() const {
    auto v = placed<plc::GradientView>();
    v.data = vectors.data();
    return v;
  }
  Point at(const Point& p) const {
    Point sum{};
    interpolate(p, [&](size_t i, double weight) {
      const plc::Float4& g = vectors[i];
      sum = sum + to_point({g.x, g.y, g.z}) * weight;
    });
    return sum;
  }
};

// Vectors of length up to 1 that turn from voxel to voxel.
inline Gradient whirl() {
  Gradient g;
  samples::Random random(5);
  const auto part = [&] { return static_cast<float>(random.uniform(-0.57, 0.57)); };
  for (size_t i = 0; i < kSide * kSide * kSide; ++i)
    g.vectors.push_back({part(), part(), part(), 0});
  return g;
}

inline Image ball() {
  return {samples::sphere_potential(samples::empty_volume({24, 24, 24}), 0.3).values};
}

// The model's own step, word for word from the paper, in the lengths of the forces: a point of the
// mesh lies at metric * point there. Results are of the mesh.
class Reference {
 public:
  Reference(const Mesh& mesh, const Model& model, const Image& image, double iso,
            const Gradient* gradient = nullptr, const plc::Metric& metric = {})
      : mesh_(mesh), model_(model), image_(image), gradient_(gradient), iso_(iso) {
    metric_ = to_point({metric.x, metric.y, metric.z});
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      x_.push_back(to_force(to_point(mesh.at(v))));
      v_.push_back(to_force(to_point(mesh.velocity.at(v))));
    }
    for (uint32_t v = 0; v < mesh.slots(); ++v) n_.push_back(normal(v));
    rest_ = rest_length();
  }

  // One step of Runge-Kutta 4: displacements and new velocities.
  void step(double dt) {
    const size_t count = x_.size();
    Points k1 = acceleration(x_, v_);
    const Points x2 = moved(x_, v_, dt / 2), v2 = moved(v_, k1, dt / 2);
    const Points k2 = acceleration(x2, v2);
    const Points x3 = moved(x_, v2, dt / 2), v3 = moved(v_, k2, dt / 2);
    const Points k3 = acceleration(x3, v3);
    const Points x4 = moved(x_, v3, dt), v4 = moved(v_, k3, dt);
    const Points k4 = acceleration(x4, v4);
    displacement.assign(count, {});
    velocity.assign(count, {});
    for (size_t i = 0; i < count; ++i) {
      displacement[i] = to_mesh((v_[i] + v2[i] * 2 + v3[i] * 2 + v4[i]) * (dt / 6));
      velocity[i] = to_mesh(v_[i] + (k1[i] + k2[i] * 2 + k3[i] * 2 + k4[i]) * (dt / 6));
    }
  }
  double longest() const {
    double most = 0;
    for (const Point& d : displacement) most = std::max(most, length(d));
    return most;
  }
  void clamp(double most, double fastest) {
    for (size_t i = 0; i < x_.size(); ++i) {
      if (length(displacement[i]) > most) {
        displacement[i] = displacement[i] * (most / length(displacement[i]));
      }
      if (length(velocity[i]) > fastest)
        velocity[i] = velocity[i] * (fastest / length(velocity[i]));
    }
  }
  // Without a metric.
  double energy(double dt) const {
    double sum = 0;
    for (size_t i = 0; i < x_.size(); ++i) {
      const double speed = dot(displacement[i], n_[i]) / (mesh_.delta * dt);
      sum += static_cast<double>(model_.mass) * speed * speed / 2;
    }
    return sum / static_cast<double>(x_.size());
  }

  Points displacement, velocity;

 private:
  Point to_force(const Point& p) const {
    return {p[0] * metric_[0], p[1] * metric_[1], p[2] * metric_[2]};
  }
  Point to_mesh(const Point& p) const {
    return {p[0] / metric_[0], p[1] / metric_[1], p[2] / metric_[2]};
  }
  Point normal(uint32_t v) const {
    Point sum{};
    const auto ring = mesh_.ring(v);
    for (uint32_t k = 0; k < ring.size(); ++k) {
      sum = sum + cross(x_[ring[k]] - x_[v], x_[ring.next(k)] - x_[v]);
    }
    return sum * (1 / length(sum));
  }
  double rest_length() const {
    if (model_.rest_length == RestLength::kZero) return 0;
    if (model_.rest_length == RestLength::kValue) {
      return static_cast<double>(model_.rest_length_value) * mesh_.delta;
    }
    double sum = 0;
    int64_t count = 0;
    samples::for_each_edge(mesh_, [&](uint32_t u, uint32_t k) {
      sum += length(x_[u] - x_[mesh_.neighbor(u, k)]);
      ++count;
    });
    return sum / static_cast<double>(count);
  }
  Point to_middle(const Points& x, uint32_t v) const {
    Point mean{};
    const auto ring = mesh_.ring(v);
    for (const uint32_t w : ring) mean = mean + x[w] * (1.0 / ring.size());
    return mean - x[v];
  }
  Point force(const Points& x, uint32_t v) const {
    const auto ring = mesh_.ring(v);
    Point curvature = to_middle(x, v);  // (5)
    Point spring{};                     // (6)
    for (const uint32_t w : ring) {
      curvature = curvature - to_middle(x, w) * (1.0 / ring.size());
      const double l = length(x[w] - x[v]);
      spring = spring + (x[w] - x[v]) * ((l - rest_) / l);
    }
    const double attraction =  // (7)
        mesh_.delta * static_cast<double>(model_.attraction) * (iso_ - image_.at(to_mesh(x[v])));
    Point along{};  // (8)
    if (gradient_ != nullptr) {
      const Point g = gradient_->at(to_mesh(x[v]));
      const Point normal = n_[v] * dot(g, n_[v]);
      along = (normal * static_cast<double>(model_.gradient_normal) +
               (g - normal) * static_cast<double>(model_.gradient_tangent)) *
              mesh_.delta;
    }
    return along + curvature * static_cast<double>(model_.curvature) +
           spring * static_cast<double>(model_.spring) + n_[v] * attraction;
  }
  // (4)
  Points acceleration(const Points& x, const Points& v) const {
    Points a;
    for (uint32_t i = 0; i < x.size(); ++i) {
      a.push_back((force(x, i) - v[i] * static_cast<double>(model_.damping)) *
                  (1 / static_cast<double>(model_.mass)));
    }
    return a;
  }
  static Points moved(const Points& x, const Points& by, double dt) {
    Points to;
    for (size_t i = 0; i < x.size(); ++i) to.push_back(x[i] + by[i] * dt);
    return to;
  }

  const Mesh& mesh_;
  const Model& model_;
  const Image& image_;
  const Gradient* gradient_;
  Point metric_{};
  double iso_, rest_ = 0;
  Points x_, v_, n_;
};

}  // namespace reference
