#include "engine/measure/nesting.h"

#include <algorithm>
#include <cmath>

#include "engine/base/blocks.h"
#include "engine/exact/predicates.h"
#include "engine/exact/triangle_intersection.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kComponentBlock = 16;

// Nothing in a mesh is parallel to these but by chance.
constexpr double kDirections[3][3] = {{0.012345678, 0.0345678912, 1},
                                      {-0.0567891234, 0.0234567891, 1},
                                      {0.0456789123, -0.0678912345, 1}};

enum class Crossing { kNone, kThrough, kTouch };

// Segment s-e against a closed triangle; kTouch where it meets an edge, a vertex or the triangle's
// plane with an end.
Crossing cross(const Point3& s, const Point3& e, const Triangle& t) {
  const Point3 &a = t.corner[0], &b = t.corner[1], &c = t.corner[2];
  const Plane plane(a, b, c);
  const int from = plane.side(s), to = plane.side(e);
  if (from * to > 0) return Crossing::kNone;
  const int ab = orient3d(s, e, a, b), bc = orient3d(s, e, b, c), ca = orient3d(s, e, c, a);
  const bool left = ab > 0 || bc > 0 || ca > 0, right = ab < 0 || bc < 0 || ca < 0;
  if (left && right) return Crossing::kNone;
  const bool touch = from == 0 || to == 0 || ab == 0 || bc == 0 || ca == 0;
  return touch ? Crossing::kTouch : Crossing::kThrough;
}

class Search {
 public:
  Search(const MeshArrays& mesh, const MeshTopology& topology, const FaceTree& tree)
      : mesh_(mesh), topology_(topology), tree_(tree) {
    double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
    for (size_t c = 0; c < 3 * topology.component.size(); ++c) {
      for (size_t k = 0; k < 3; ++k) {
        const double x = mesh.corner(c)[k];
        low[k] = c == 0 ? x : std::min(low[k], x);
        high[k] = c == 0 ? x : std::max(high[k], x);
      }
    }
    for (int k = 0; k < 3; ++k) reach_ = std::max(reach_, 2 * (high[k] - low[k]));
  }

  // Whether a ray from s crosses the components other than `own` an odd number of times.
  bool is_nested(const Point3& s, uint32_t own) const {
    int votes = 0;
    for (const double* d : {kDirections[0], kDirections[1], kDirections[2]}) {
      const Point3 e{s.x + reach_ * d[0], s.y + reach_ * d[1], s.z + reach_ * d[2]};
      bool odd = false, clean = true;
      tree_.along_segment(s, e, [&](uint32_t f) {
        if (topology_.component[f] == own) return;
        const Crossing c = cross(s, e, make_triangle(mesh_.xyz, mesh_.face(f)));
        odd ^= c != Crossing::kNone;
        clean &= c != Crossing::kTouch;
      });
      if (clean) return odd;
      votes += odd ? 1 : 0;
    }
    return votes >= 2;
  }

 private:
  MeshArrays mesh_;
  const MeshTopology& topology_;
  const FaceTree& tree_;
  double reach_ = 0;  // takes a ray out of the mesh
};

// The centre of each component's largest face (not a vertex: components may share one).
Vector<Point3> starts(const MeshArrays& mesh, const MeshTopology& topology) {
  Vector<Point3> start(topology.components.size(), Point3{0, 0, 0});
  Vector<double> largest(topology.components.size(), -1);
  for (size_t f = 0; f < topology.component.size(); ++f) {
    const Triangle t = make_triangle(mesh.xyz, mesh.face(f));
    const Point3 &a = t.corner[0], &b = t.corner[1], &c = t.corner[2];
    const double ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
    const double vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
    const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    const double area = x * x + y * y + z * z;
    const uint32_t component = topology.component[f];
    if (!(area > largest[component])) continue;
    largest[component] = area;
    start[component] = {a.x + (ux + vx) / 3, a.y + (uy + vy) / 3, a.z + (uz + vz) / 3};
  }
  return start;
}

}  // namespace

Vector<ComponentSide> component_sides(const MeshArrays& mesh, const MeshTopology& topology,
                                      const Vector<ComponentMeasures>& measures,
                                      const FaceTree& tree, const Executor& executor) {
  Vector<ComponentSide> sides(measures.size());
  const Search search(mesh, topology, tree);
  const Vector<Point3> start = starts(mesh, topology);
  run_blocks(executor, measures.size(), kComponentBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const uint32_t own = measures[i].component;
      const bool nested = measures.size() > 1 && search.is_nested(start[own], own);
      const double volume = nested ? -measures[i].volume : measures[i].volume;
      sides[own] = {nested, !(volume > 0)};
    }
  });
  return sides;
}

}  // namespace plc
