// Vessels: trees that wander, taper and branch.
#include <algorithm>
#include <cmath>

#include "tools/phantom/phantoms.h"
#include "tools/phantom/phantoms_canvas.h"
#include "tools/phantom/phantoms_random.h"

namespace plc::tools {
namespace {

constexpr double kBackground = 0.2;
constexpr double kTube = 0.8;
constexpr double kNoise = 0.04;
constexpr int kTrees = 4;
constexpr int kDepth = 7;  // of branching: up to 2^7 twigs a tree
// In units of the smallest extent: a trunk of 3.7 mm, twigs of 0.8 mm in 124 mm.
constexpr double kTrunkRadius = 0.03;
constexpr double kTrunkLength = 0.35;
constexpr double kBend = 0.2;          // of the direction, per step
constexpr double kFork = 0.7;          // of the direction, at a branching
constexpr double kLengthRatio = 0.88;  // of a branch to its parent
constexpr int kSteps = 10;             // of a branch

Point sum(const Point& a, const Point& b, double factor) {
  return {a.x + factor * b.x, a.y + factor * b.y, a.z + factor * b.z};
}
double dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

Point unit(const Point& a) {
  const double length = std::sqrt(dot(a, a));
  return {a.x / length, a.y / length, a.z / length};
}

Point random_direction(Random& random) {
  for (;;) {  // a point of the unit ball
    const Point p{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const double squared = dot(p, p);
    if (squared <= 1 && squared > 1e-4) return unit(p);
  }
}

class Painter {
 public:
  Painter(const Canvas& canvas, std::vector<double>& field) : canvas_(canvas), field_(field) {}

  // A cone's frustum with round ends, blurred over a voxel's width about its surface.
  void segment(const Point& a, const Point& b, double radius_a, double radius_b) {
    const double blur = std::max({canvas_.spacing[0], canvas_.spacing[1], canvas_.spacing[2]});
    const double reach = std::max(radius_a, radius_b) + blur;
    const Point along = sum(b, a, -1);
    const double squared = dot(along, along);
    int64_t low[3];
    int64_t high[3];
    bounds(a, b, reach, low, high);
    for (int64_t k = low[2]; k <= high[2]; ++k) {
      for (int64_t j = low[1]; j <= high[1]; ++j) {
        for (int64_t i = low[0]; i <= high[0]; ++i) {
          const Point p{static_cast<double>(i) * canvas_.spacing[0],
                        static_cast<double>(j) * canvas_.spacing[1],
                        static_cast<double>(k) * canvas_.spacing[2]};
          const Point from_a = sum(p, a, -1);
          const double t = std::clamp(dot(from_a, along) / squared, 0.0, 1.0);
          const Point off = sum(from_a, along, -t);
          const double radius = radius_a + t * (radius_b - radius_a);
          const double depth = (radius - std::sqrt(dot(off, off))) / blur;
          const double cover = std::clamp(0.5 + 0.5 * depth, 0.0, 1.0);
          double& value =
              field_[static_cast<size_t>(i + canvas_.size[0] * (j + canvas_.size[1] * k))];
          value = std::max(value, kBackground + (kTube - kBackground) * cover);
        }
      }
    }
  }

 private:
  void bounds(const Point& a, const Point& b, double reach, int64_t low[3], int64_t high[3]) const {
    const double from[3] = {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
    const double to[3] = {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
    for (int axis = 0; axis < 3; ++axis) {
      const auto last = static_cast<double>(canvas_.size[axis] - 1);
      const double step = canvas_.spacing[axis];
      // Beyond the image on one side leaves the range empty.
      low[axis] =
          static_cast<int64_t>(std::clamp(std::ceil((from[axis] - reach) / step), 0.0, last + 1));
      high[axis] =
          static_cast<int64_t>(std::clamp(std::floor((to[axis] + reach) / step), -1.0, last));
    }
  }
  const Canvas& canvas_;
  std::vector<double>& field_;
};

struct Branch {
  Point start, direction;
  double radius, length;
  int depth;  // branchings to come
};

// Paints a branch; its children where it ends.
std::pair<Branch, Branch> grow(const Canvas& canvas, const Branch& branch, Random& random,
                               Painter& painter) {
  const Point centre = canvas.centre();
  const double thinnest = 0.5 * std::min({canvas.spacing[0], canvas.spacing[1], canvas.spacing[2]});
  const double share = random.uniform(0.4, 0.6);
  // Murray's law, radius^3 kept at a branching, for the mean of the two children.
  const double narrowed = branch.radius * 0.7937;
  Point at = branch.start;
  Point direction = branch.direction;
  double radius = branch.radius;
  for (int step = 0; step < kSteps; ++step) {
    direction = unit(sum(direction, random_direction(random), kBend));
    Point next = sum(at, direction, branch.length / kSteps);
    // Turned back towards the middle where it would leave the image.
    const double margin = radius + 1;
    const double out[3] = {next.x, next.y, next.z};
    bool leaves = false;
    for (int axis = 0; axis < 3; ++axis) {
      leaves |= out[axis] < margin || out[axis] > canvas.extent(axis) - margin;
    }
    if (leaves) {
      direction = unit(sum(direction, unit(sum(centre, at, -1)), 1.5));
      next = sum(at, direction, branch.length / kSteps);
    }
    const double thinner = radius + (narrowed - branch.radius) / kSteps;
    painter.segment(at, next, std::max(radius, thinnest), std::max(thinner, thinnest));
    at = next;
    radius = thinner;
  }
  const Point sideways = random_direction(random);
  const auto child = [&](double sign, double part) {
    return Branch{at, unit(sum(direction, sideways, sign * kFork)), radius * (0.5 + part),
                  branch.length * kLengthRatio * random.uniform(0.7, 1.2), branch.depth - 1};
  };
  const Branch first = child(1, share);
  return {first, child(-1, 1 - share)};
}

}  // namespace

LoadedVolume vessels_phantom(const PhantomOptions& options) {
  const Canvas canvas("vessels", options, {{256, 256, 124}, PLC_I16, kNoise});
  const int trees = checked_count("vessels", "number of trees", options.count, kTrees, 10000);
  const int depth = checked_count("vessels", "depth", options.depth, kDepth, 12);
  std::vector<double> field = canvas.field(kBackground);
  Painter painter(canvas, field);
  Random random(options.seed);
  const double extent = canvas.smallest_extent();
  for (int tree = 0; tree < trees; ++tree) {
    Branch root{};
    root.start = {canvas.extent(0) * random.uniform(0.1, 0.9),
                  canvas.extent(1) * random.uniform(0.1, 0.9), kTrunkRadius * extent + 2};
    root.direction = unit(sum({0, 0, 1}, random_direction(random), 0.3));
    root.radius = kTrunkRadius * extent;
    root.length = kTrunkLength * extent;
    root.depth = depth;
    std::vector<Branch> branches = {root};
    while (!branches.empty()) {
      const Branch branch = branches.back();
      branches.pop_back();
      const auto [first, second] = grow(canvas, branch, random, painter);
      if (branch.depth <= 0) continue;
      branches.push_back(first);
      branches.push_back(second);
    }
  }
  return canvas.volume(field);
}

}  // namespace plc::tools
