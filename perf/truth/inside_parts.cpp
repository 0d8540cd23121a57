#include "perf/truth/inside_parts.h"

#include <algorithm>
#include <cmath>

namespace truth {
namespace {

using plc::Double3;

// A cell that the surface crosses is halved once along each axis.
constexpr int kHalvings = 1;

double part_inside(const Scene& scene, const Double3& centre, const Double3& half, int halvings) {
  const double distance = scene.signed_distance(centre);
  if (std::abs(distance) >= length(half)) return distance < 0 ? 1 : 0;
  if (halvings == 0) {
    constexpr double kStep = 1e-5;  // mm
    const auto along = [&](const Double3& step) {
      return (scene.signed_distance(centre + step) - distance) / kStep;
    };
    const Double3 normal{along({kStep, 0, 0}), along({0, kStep, 0}), along({0, 0, kStep})};
    return part_below_plane(half, distance, normal);
  }
  const Double3 quarter = half * 0.5;
  double sum = 0;
  for (unsigned k = 0; k < 8; ++k) {
    const Double3 step{(k & 1) != 0 ? quarter.x : -quarter.x, (k & 2) != 0 ? quarter.y : -quarter.y,
                       (k & 4) != 0 ? quarter.z : -quarter.z};
    sum += part_inside(scene, centre + step, quarter, halvings - 1);
  }
  return sum / 8;
}

// The fine cells of one voxel.
class Voxel {
 public:
  Voxel(const Scene& scene, const std::array<int, 3>& fine) : scene_(scene), fine_(fine) {
    const auto half = [&](size_t a) { return scene.spacing[a] / (2 * fine[a]); };
    half_ = {half(0), half(1), half(2)};
  }

  void fill(const std::array<int, 3>& voxel, float* cells, size_t row, size_t plane) const {
    const auto& s = scene_.spacing;
    const Double3 centre{voxel[0] * s[0], voxel[1] * s[1], voxel[2] * s[2]};
    const double distance = scene_.signed_distance(centre);
    const bool whole = std::abs(distance) >= length(Double3{s[0] / 2, s[1] / 2, s[2] / 2});
    for (int z = 0; z < fine_[2]; ++z) {
      for (int y = 0; y < fine_[1]; ++y) {
        float* to = cells + static_cast<size_t>(z) * plane + static_cast<size_t>(y) * row;
        for (int x = 0; x < fine_[0]; ++x) {
          const auto off = [&](int i, size_t a) { return (i + 0.5) / fine_[a] * s[a] - s[a] / 2; };
          const Double3 at = centre + Double3{off(x, 0), off(y, 1), off(z, 2)};
          const double part =
              whole ? (distance < 0 ? 1 : 0) : part_inside(scene_, at, half_, kHalvings);
          *to++ = static_cast<float>(part);
        }
      }
    }
  }

 private:
  const Scene& scene_;
  std::array<int, 3> fine_;
  Double3 half_;
};

}  // namespace

double part_below_plane(const Double3& half, double distance, const Double3& normal) {
  double a[3] = {std::abs(normal.x) * half.x, std::abs(normal.y) * half.y,
                 std::abs(normal.z) * half.z};
  // The formula divides by their product. So small a slope moves the part by less than its square.
  const double most = std::max({a[0], a[1], a[2]});
  if (!(most > 0)) return distance < 0 ? 1 : 0;
  for (double& x : a) x = std::max(x, 1e-3 * most);
  const double level = a[0] + a[1] + a[2] - distance;  // from the lowest corner
  const auto cubed = [](double x) { return x > 0 ? x * x * x : 0; };
  double sum = cubed(level);
  for (size_t i = 0; i < 3; ++i) {
    sum -= cubed(level - 2 * a[i]);
    sum += cubed(level - 2 * (a[i] + a[(i + 1) % 3]));
  }
  sum -= cubed(level - 2 * (a[0] + a[1] + a[2]));
  return std::clamp(sum / (48 * a[0] * a[1] * a[2]), 0.0, 1.0);
}

std::vector<float> inside_parts(const Scene& scene, const std::array<int, 3>& fine,
                                const plc::Executor& executor) {
  const auto size = [](int n) { return static_cast<size_t>(n); };
  std::array<size_t, 3> cells{};
  for (size_t a = 0; a < 3; ++a) cells[a] = size(scene.dims[a]) * size(fine[a]);
  std::vector<float> parts(cells[0] * cells[1] * cells[2]);
  const Voxel voxel(scene, fine);
  const size_t plane = cells[0] * cells[1];
  executor.run(size(scene.dims[2]), [&](size_t slice) {
    const int z = static_cast<int>(slice);
    for (int y = 0; y < scene.dims[1]; ++y) {
      for (int x = 0; x < scene.dims[0]; ++x) {
        float* first = parts.data() + size(z) * size(fine[2]) * plane +
                       size(y) * size(fine[1]) * cells[0] + size(x) * size(fine[0]);
        voxel.fill({x, y, z}, first, cells[0], plane);
      }
    }
  });
  return parts;
}

}  // namespace truth
