#include "perf/truth/fine_field.h"

#include <algorithm>
#include <cmath>

#include "perf/truth/inside_parts.h"

namespace truth {
namespace {

using plc::Double3;

constexpr double kLongest = 0.27;  // mm, of a fine cell
constexpr double kReach = 5;       // sigmas

// Weights of the cells from -size / 2 to size / 2 - 1 about a node: the voxel's box, `fine` cells,
// convolved with the samples of the Gaussian.
std::vector<float> weights(int fine, double sigma) {
  const int reach = static_cast<int>(std::ceil(kReach * sigma * fine));
  std::vector<double> gaussian;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    const double at = sigma > 0 ? i / (sigma * fine) : 0;
    gaussian.push_back(std::exp(-at * at / 2));
    sum += gaussian.back();
  }
  std::vector<double> result(static_cast<size_t>(2 * reach + fine));
  for (size_t i = 0; i < gaussian.size(); ++i) {
    for (size_t k = 0; k < static_cast<size_t>(fine); ++k) {
      result[i + k] += gaussian[i] / sum / fine;
    }
  }
  return {result.begin(), result.end()};
}

// Along one axis, from cells to nodes: [outer][n][inner] to [outer][n + 1][inner].
std::vector<float> blurred(const std::vector<float>& from, size_t n, size_t inner,
                           const std::vector<float>& weight, const plc::Executor& executor) {
  const size_t outer = from.size() / (n * inner), half = weight.size() / 2;
  std::vector<float> to(outer * (n + 1) * inner, 0.0F);
  // Columns of `width` values stay in the cache for all weights.
  const size_t width = std::min<size_t>(inner, 512), columns = (inner + width - 1) / width;
  executor.run(outer * columns, [&](size_t task) {
    const size_t o = task / columns, begin = task % columns * width;
    const size_t count = std::min(width, inner - begin);
    const float* source = from.data() + o * n * inner + begin;
    float* target = to.data() + o * (n + 1) * inner + begin;
    for (size_t k = 0; k < weight.size(); ++k) {
      // Node i takes cell i + k - half.
      const size_t first = half > k ? half - k : 0;
      const size_t last = n + half > k ? std::min(n + 1, n + half - k) : 0;
      if (first >= last) continue;
      const float w = weight[k];
      const float* in = source + (first + k - half) * inner;
      float* out = target + first * inner;
      const bool whole = count == inner;  // one run of values
      const size_t run = whole ? (last - first) * inner : count;
      for (size_t i = whole ? last - 1 : first; i < last; ++i, in += inner, out += inner) {
        for (size_t x = 0; x < run; ++x) out[x] += w * in[x];
      }
    }
  });
  return to;
}

// Of the four nodes before and after a place at `t` between the middle two.
std::array<double, 4> cubic_weights(double t) {
  return {-t * (t - 1) * (t - 2) / 6, (t + 1) * (t - 1) * (t - 2) / 2, -(t + 1) * t * (t - 2) / 2,
          (t + 1) * t * (t - 1) / 6};
}

}  // namespace

std::array<int, 3> fineness(const Scene& scene) {
  std::array<int, 3> fine{};
  for (size_t a = 0; a < 3; ++a) {
    fine[a] = std::max(4, 2 * static_cast<int>(std::ceil(scene.spacing[a] / (2 * kLongest))));
  }
  return fine;
}

FineField::FineField(const Scene& scene, const plc::Executor& executor)
    : dims_(scene.dims), fine_(fineness(scene)), spacing_(scene.spacing), nodes_{} {
  values_ = inside_parts(scene, fine_, executor);
  size_t inner = 1;
  for (size_t a = 0; a < 3; ++a) {
    const auto cells = static_cast<size_t>(dims_[a]) * static_cast<size_t>(fine_[a]);
    nodes_[a] = cells + 1;
    values_ = blurred(values_, cells, inner, weights(fine_[a], scene.sigma), executor);
    inner *= nodes_[a];
  }
}

Double3 FineField::place(const Double3& node) const {
  return {(node.x / fine_[0] - 0.5) * spacing_[0], (node.y / fine_[1] - 0.5) * spacing_[1],
          (node.z / fine_[2] - 0.5) * spacing_[2]};
}

double FineField::at(const Double3& place) const {
  const double p[3] = {place.x, place.y, place.z};
  size_t first[3];
  std::array<double, 4> w[3];
  for (size_t a = 0; a < 3; ++a) {
    const double node = (p[a] / spacing_[a] + 0.5) * fine_[a];
    if (!(node >= 0 && node <= static_cast<double>(nodes_[a] - 1))) return 0;
    const double low = std::clamp(std::floor(node), 1.0, static_cast<double>(nodes_[a] - 3));
    first[a] = static_cast<size_t>(low) - 1;
    w[a] = cubic_weights(node - low);
  }
  double sum = 0;
  for (size_t z = 0; z < 4; ++z) {
    for (size_t y = 0; y < 4; ++y) {
      const float* v = row(first[1] + y, first[2] + z) + first[0];
      double line = 0;
      for (size_t x = 0; x < 4; ++x) line += w[0][x] * static_cast<double>(v[x]);
      sum += w[2][z] * w[1][y] * line;
    }
  }
  return sum;
}

Double3 FineField::gradient(const Double3& p) const {
  constexpr double kStep = 0.05;  // mm
  const auto along = [&](const Double3& step) {
    return (at(p + step) - at(p - step)) / (2 * kStep);
  };
  return {along({kStep, 0, 0}), along({0, kStep, 0}), along({0, 0, kStep})};
}

std::vector<float> FineField::voxels() const {
  std::vector<float> image;
  const auto node_of = [&](int i, size_t a) {
    const auto fine = static_cast<size_t>(fine_[a]);
    return fine * static_cast<size_t>(i) + fine / 2;
  };
  for (int z = 0; z < dims_[2]; ++z) {
    for (int y = 0; y < dims_[1]; ++y) {
      for (int x = 0; x < dims_[0]; ++x) {
        image.push_back(node(node_of(x, 0), node_of(y, 1), node_of(z, 2)));
      }
    }
  }
  return image;
}

}  // namespace truth
