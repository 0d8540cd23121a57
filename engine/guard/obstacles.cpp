#include "engine/guard/obstacles.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "engine/base/double3.h"
#include "engine/exact/predicates.h"
#include "engine/measure/point_triangle.h"

namespace plc {

namespace {

// Ids that no vertex of a mesh has: the surface shares none with what it may not meet.
constexpr std::array<uint32_t, 3> kForeign = {~0U - 2, ~0U - 1, ~0U};

using Point = std::array<double, 3>;
using Points = std::array<Point, 3>;

Points points_of(const Corners& face) {
  Points p;
  for (size_t k = 0; k < 3; ++k) p[k] = {face[k].x, face[k].y, face[k].z};
  return p;
}

Point3 point3(const Point& p) {
  return {p[0], p[1], p[2]};
}

struct Bounds {
  Point low, high;
};

Bounds bounds_of(const Corners* faces, size_t count, double reach) {
  Bounds b{points_of(faces[0])[0], points_of(faces[0])[0]};
  for (size_t i = 0; i < count; ++i) {
    for (const Point& p : points_of(faces[i])) {
      for (size_t a = 0; a < 3; ++a) {
        b.low[a] = std::min(b.low[a], p[a]);
        b.high[a] = std::max(b.high[a], p[a]);
      }
    }
  }
  for (size_t a = 0; a < 3; ++a) {
    b.low[a] -= reach;
    b.high[a] += reach;
  }
  return b;
}

// Of the segments p-q and r-s, where they are nearest within both of them; at their ends distances
// of points to triangles tell.
double between_segments(const Point& p, const Point& q, const Point& r, const Point& s) {
  const Double3 u = difference(q.data(), p.data()), v = difference(s.data(), r.data());
  const Double3 w = difference(p.data(), r.data());
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double square = uu * vv - uv * uv;
  const double along = uv * vw - vv * uw, across = uu * vw - uv * uw;
  if (!(square > 0) || along < 0 || along > square || across < 0 || across > square) {
    return std::numeric_limits<double>::infinity();
  }
  const Double3 way = w + u * (along / square) - v * (across / square);
  return dot(way, way);
}

// Of two triangles that do not meet.
double between_triangles(const Points& f, const Points& g) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < 3; ++i) {
    least = std::min(
        least, squared_distance_to_triangle(f[i].data(), g[0].data(), g[1].data(), g[2].data()));
    least = std::min(
        least, squared_distance_to_triangle(g[i].data(), f[0].data(), f[1].data(), f[2].data()));
    for (size_t k = 0; k < 3; ++k) {
      least = std::min(least, between_segments(f[i], f[(i + 1) % 3], g[k], g[(k + 1) % 3]));
    }
  }
  return least;
}

// Whether a line from p upwards goes through the triangle. Exact for a p that is moved by next to
// nothing towards +y, and by much less towards +x: of triangles that share an edge below or above
// it one is hit then, and of a closed surface an even number, or an odd one where p is inside.
bool is_above(const Points& t, const Point& p) {
  bool inside = false;
  for (size_t k = 0; k < 3; ++k) {
    const Point *a = &t[k], *b = &t[(k + 1) % 3];
    if ((a->at(1) > p[1]) == (b->at(1) > p[1])) continue;
    if (a->at(1) > b->at(1)) std::swap(a, b);
    // Left of an edge that goes up: a line towards +x crosses it.
    inside ^= orient2d((*a)[0], (*a)[1], (*b)[0], (*b)[1], p[0], p[1]) > 0;
  }
  if (!inside) return false;
  const int upward = orient2d(t[0][0], t[0][1], t[1][0], t[1][1], t[2][0], t[2][1]);
  return upward * orient3d(point3(t[0]), point3(t[1]), point3(t[2]), point3(p)) < 0;
}

}  // namespace

Obstacles::Obstacles(Vector<double> xyz, Vector<uint32_t> abc, double gap, const Executor& executor)
    : xyz_(std::move(xyz)), abc_(std::move(abc)), gap_(gap) {
  Vector<uint32_t> faces(abc_.size() / 3);
  std::iota(faces.begin(), faces.end(), 0U);
  tree_.build(xyz_.data(), abc_.data(), faces.data(), faces.size(), executor);
  // What hangs together by vertices; of each component its first one.
  Vector<uint32_t> first(xyz_.size() / 3);
  std::iota(first.begin(), first.end(), 0U);
  const auto root = [&](uint32_t v) {
    while (first[v] != v) v = first[v] = first[first[v]];
    return v;
  };
  for (size_t i = 0; i < abc_.size(); ++i) {
    const uint32_t a = root(abc_[i]), b = root(abc_[i - i % 3]);
    first[std::max(a, b)] = std::min(a, b);
  }
  Vector<char> listed(first.size(), 0);
  for (const uint32_t v : abc_) {
    const uint32_t r = root(v);
    if (listed[r] == 0) points_.insert(points_.end(), {r, r, r});
    listed[r] = 1;
  }
  faces.resize(points_.size() / 3);
  std::iota(faces.begin(), faces.end(), 0U);
  point_tree_.build(xyz_.data(), points_.data(), faces.data(), faces.size(), executor);
}

Triangle Obstacles::triangle(uint32_t face) const {
  Triangle t = make_triangle(xyz_.data(), abc_.data() + 3 * size_t{face});
  std::copy(kForeign.begin(), kForeign.end(), t.vertex);
  return t;
}

template <typename Visit>
void Obstacles::visit_near(const Corners& face, double reach, const Visit& visit) const {
  const Bounds b = bounds_of(&face, 1, reach);
  tree_.within(b.low.data(), b.high.data(), visit);
}

double Obstacles::squared_distance(const Corners& face, double limit) const {
  double least = limit;
  const Points own = points_of(face);
  visit_near(face, gap_, [&](uint32_t f) {
    Points other;
    for (size_t k = 0; k < 3; ++k) {
      const double* p = xyz_.data() + 3 * size_t{abc_[3 * size_t{f} + k]};
      other[k] = {p[0], p[1], p[2]};
    }
    least = std::min(least, between_triangles(own, other));
  });
  return least;
}

bool Obstacles::refuse(const Corners& now, const Corners* before, size_t count) const {
  const Points p = points_of(now);
  const Triangle face{{point3(p[0]), point3(p[1]), point3(p[2])}, {0, 1, 2}};
  bool meets = false, near = false;
  visit_near(now, gap_, [&](uint32_t f) {
    near = true;
    meets = meets || triangles_intersect(face, triangle(f));
  });
  if (meets || !near || gap_ == 0) return meets;
  const double limit = gap_ * gap_;
  const double distance = squared_distance(now, limit);
  if (distance >= limit) return false;
  double nearest = limit;
  for (size_t i = 0; i < count; ++i)
    nearest = std::min(nearest, squared_distance(before[i], limit));
  return distance < nearest;
}

bool Obstacles::any_near(const Corners* faces, size_t count) const {
  const Bounds b = bounds_of(faces, count, 0);
  bool any = false;
  point_tree_.within(b.low.data(), b.high.data(), [&](uint32_t) { any = true; });
  return any;
}

bool Obstacles::passed_over(const Vector<Corners>& before, const Vector<Corners>& now) const {
  Vector<Corners> all = before;
  all.insert(all.end(), now.begin(), now.end());
  const Bounds b = bounds_of(all.data(), all.size(), 0);
  bool any = false;
  point_tree_.within(b.low.data(), b.high.data(), [&](uint32_t i) {
    const double* at = xyz_.data() + 3 * size_t{points_[3 * size_t{i}]};
    const Point p{at[0], at[1], at[2]};
    bool odd = false;
    for (const Corners& face : all) odd ^= is_above(points_of(face), p);
    any = any || odd;
  });
  return any;
}

bool Obstacles::any_inside(const Mesh& mesh, const Vector<uint32_t>& component) const {
  Vector<Corners> faces;
  for (const uint32_t v : component) {
    const uint32_t d = mesh.valence(v);
    for (uint32_t k = 0; k < d; ++k) {
      const uint32_t a = mesh.neighbor(v, k), b = mesh.neighbor(v, k + 1 == d ? 0 : k + 1);
      if (v < a && v < b) faces.push_back({mesh.at(v), mesh.at(a), mesh.at(b)});
    }
  }
  return passed_over(faces, {});
}

bool Obstacles::find_meeting(const Mesh& mesh, Meeting& meeting) const {
  const Vector<uint32_t> faces = mesh.faces();
  for (size_t i = 0; i < faces.size(); i += 3) {
    const uint32_t* abc = faces.data() + i;
    const Triangle face = make_triangle(mesh.position.data(), abc);
    const Corners corners{mesh.at(abc[0]), mesh.at(abc[1]), mesh.at(abc[2])};
    bool found = false;
    visit_near(corners, 0, [&](uint32_t f) {
      if (found || !triangles_intersect(face, triangle(f))) return;
      found = true;
      meeting = {{abc[0], abc[1], abc[2]}, f};
    });
    if (found) return true;
  }
  return false;
}

}  // namespace plc
