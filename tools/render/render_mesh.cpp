#include "tools/render/render_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/file/failure.h"

namespace plc::tools {

namespace {

using Triple = std::array<double, 3>;

struct Box {
  Triple middle;
  double half = 0;  // of its longest side
};

// Sums and differences of halves, as those of doubles may be beyond what doubles hold.
Box box_of(const std::string& path, const std::vector<double>& xyz) {
  constexpr double kMost = std::numeric_limits<double>::max();
  Triple low = {kMost, kMost, kMost};
  Triple high = {-kMost, -kMost, -kMost};
  for (size_t i = 0; i < xyz.size(); ++i) {
    if (!std::isfinite(xyz[i])) {
      throw Failure{path + ": " + "xyz"[i % 3] + " of its point " + std::to_string(i / 3) + " is " +
                    (std::isnan(xyz[i]) ? "not a number" : "infinite")};
    }
    low[i % 3] = std::min(low[i % 3], xyz[i]);
    high[i % 3] = std::max(high[i % 3], xyz[i]);
  }
  Box box{};
  for (size_t axis = 0; axis < 3; ++axis) {
    box.middle[axis] = low[axis] / 2 + high[axis] / 2;
    box.half = std::max(box.half, high[axis] / 2 - low[axis] / 2);
  }
  return box;
}

}  // namespace

DrawnMesh drawn_mesh(const std::string& path, const TriangleMesh& mesh) {
  if (mesh.abc.empty()) throw Failure{path + ": has no face: there is nothing to draw"};
  const Box box = box_of(path, mesh.xyz);
  if (!(box.half > 0)) throw Failure{path + ": all its points are in one place: nothing to draw"};
  const auto scaled = [&](double value, size_t axis) {
    return static_cast<float>((value / 2 - box.middle[axis] / 2) / box.half * 2);
  };
  DrawnMesh drawn;
  drawn.points.reserve(mesh.xyz.size() / 3);
  for (size_t i = 0; i + 2 < mesh.xyz.size(); i += 3) {
    const double* p = &mesh.xyz[i];
    drawn.points.push_back({scaled(p[0], 0), scaled(p[1], 1), scaled(p[2], 2)});
  }
  for (size_t f = 0; f + 2 < mesh.abc.size(); f += 3) {
    const Vec3f a = drawn.points[mesh.abc[f]];
    const Vec3f n = cross(drawn.points[mesh.abc[f + 1]] - a, drawn.points[mesh.abc[f + 2]] - a);
    if (!(dot(n, n) > 0)) continue;
    for (size_t k = 0; k < 3; ++k) drawn.abc.push_back(mesh.abc[f + k]);
  }
  if (drawn.abc.empty()) {
    throw Failure{path + ": no face of it has an area, beside its extent: nothing to draw"};
  }
  return drawn;
}

}  // namespace plc::tools
