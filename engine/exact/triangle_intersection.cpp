// Exact triangle-triangle tests from orientation signs.
//
// Disjoint faces: P. Guigue, O. Devillers, "Fast and Robust Triangle-Triangle Overlap Test Using
// Orientation Predicates", Journal of Graphics Tools 8(1), 2003. Faces with a common vertex need
// no more than the signs of the four other vertices (below).
#include "engine/exact/triangle_intersection.h"

#include <array>
#include <utility>

namespace plc {
namespace {

// ---- in a common plane ----------------------------------------------------------------------

// Orientation in the projection along one axis.
int turn(int axis, const Point3& a, const Point3& b, const Point3& c) {
  if (axis == 0) return orient2d(a.y, a.z, b.y, b.z, c.y, c.z);
  if (axis == 1) return orient2d(a.z, a.x, b.z, b.x, c.z, c.x);
  return orient2d(a.x, a.y, b.x, b.y, c.x, c.y);
}

// An axis along which the triangle projects to a triangle, and how it turns there; 0 when it is
// degenerate. The projection is then one to one on the plane of the triangle.
struct Projection {
  int axis;
  int turn;
};
Projection project(const Point3& a, const Point3& b, const Point3& c) {
  for (int axis = 0; axis < 3; ++axis) {
    const int t = turn(axis, a, b, c);
    if (t != 0) return {axis, t};
  }
  return {0, 0};
}

// Counter-clockwise a, b, c: is some edge's line strictly between the triangle and all of p, q, r?
bool edge_separates(int axis, const Point3* t, const Point3* other) {
  for (int k = 0; k < 3; ++k) {
    const Point3 &a = t[k], &b = t[(k + 1) % 3];
    if (turn(axis, a, b, other[0]) < 0 && turn(axis, a, b, other[1]) < 0 &&
        turn(axis, a, b, other[2]) < 0) {
      return true;
    }
  }
  return false;
}

// Closed coplanar triangles are disjoint exactly when an edge of one separates them strictly.
bool coplanar_overlap(const Point3* f, const Point3* g) {
  const Projection p = project(f[0], f[1], f[2]);
  if (p.turn == 0) return false;
  const int turn_g = turn(p.axis, g[0], g[1], g[2]);
  if (turn_g == 0) return false;
  const std::array<Point3, 3> a = {f[0], p.turn > 0 ? f[1] : f[2], p.turn > 0 ? f[2] : f[1]};
  const std::array<Point3, 3> b = {g[0], turn_g > 0 ? g[1] : g[2], turn_g > 0 ? g[2] : g[1]};
  return !edge_separates(p.axis, a.data(), b.data()) && !edge_separates(p.axis, b.data(), a.data());
}

// Coplanar faces (v, a, b) and (v, c, d): their cones at v meet outside v exactly when a side of
// one lies in the other.
bool coplanar_cones_meet(const Point3& v, Point3 a, Point3 b, Point3 c, Point3 d) {
  const Projection p = project(v, a, b);
  if (p.turn == 0) return false;
  const int turn_g = turn(p.axis, v, c, d);
  if (turn_g == 0) return false;
  if (p.turn < 0) std::swap(a, b);
  if (turn_g < 0) std::swap(c, d);
  const int ac = turn(p.axis, v, a, c), ad = turn(p.axis, v, a, d);
  const int bc = turn(p.axis, v, b, c), bd = turn(p.axis, v, b, d);
  return (ac >= 0 && bc <= 0) || (ad >= 0 && bd <= 0) ||  // c or d between a and b
         (ac <= 0 && ad >= 0);                            // or else both a and b between c and d
}

// ---- faces without a common vertex ----------------------------------------------------------

struct Signs {
  int s[3];
  bool one_side() const { return (s[0] > 0 && s[1] > 0 && s[2] > 0) || all_negative(); }
  bool all_negative() const { return s[0] < 0 && s[1] < 0 && s[2] < 0; }
  bool all_zero() const { return s[0] == 0 && s[1] == 0 && s[2] == 0; }
};

Signs sides(const Plane& plane, const Point3* p) {
  return {{plane.side(p[0]), plane.side(p[1]), plane.side(p[2])}};
}

// The corner that the other face's plane cuts off: alone on its side (1, -1), the other two on the
// other side or in the plane, or in the plane with the other two on one side.
struct Alone {
  int corner;
  int side;
};
Alone find_alone(const Signs& t) {
  for (int k = 0; k < 3; ++k) {
    const int s = t.s[k], s1 = t.s[(k + 1) % 3], s2 = t.s[(k + 2) % 3];
    if ((s > 0 && s1 <= 0 && s2 <= 0) || (s == 0 && s1 < 0 && s2 < 0)) return {k, 1};
    if ((s < 0 && s1 >= 0 && s2 >= 0) || (s == 0 && s1 > 0 && s2 > 0)) return {k, -1};
  }
  return {0, 1};  // not reached: the signs are neither all one side nor all zero
}

bool disjoint_faces_meet(const Point3* f, const Point3* g) {
  const Signs of_g = sides(Plane(f[0], f[1], f[2]), g);
  if (of_g.one_side()) return false;
  if (of_g.all_zero()) return coplanar_overlap(f, g);
  const Signs of_f = sides(Plane(g[0], g[1], g[2]), f);
  if (of_f.one_side()) return false;
  if (of_f.all_zero()) return false;  // g is degenerate: otherwise f would have been coplanar
  // Both triangles meet the line in which their planes intersect, in intervals that end on the
  // edges at the corner that is alone. With both corners on the positive side of the other plane,
  // the intervals overlap exactly when two orientations say so.
  const Alone i = find_alone(of_f), j = find_alone(of_g);
  const Point3 &pf = f[i.corner], &pg = g[j.corner];
  const Point3 *qf = &f[(i.corner + 1) % 3], *rf = &f[(i.corner + 2) % 3];
  const Point3 *qg = &g[(j.corner + 1) % 3], *rg = &g[(j.corner + 2) % 3];
  if (j.side < 0) std::swap(qf, rf);  // turns the plane of f over
  if (i.side < 0) std::swap(qg, rg);
  return orient3d(pf, *qf, pg, *qg) <= 0 && orient3d(pf, *rf, pg, *rg) >= 0;
}

// ---- faces with one common vertex -----------------------------------------------------------

// Faces (v, a, b) and (v, c, d). When c and d are not on the same side of the plane of (v, a, b),
// segment c-d meets that plane in Y = (s_c d - s_d c) / (s_c - s_d), s_x = det(a, b, x) from v.
// Y = alpha a + beta b with alpha ~ det(c, d, b) and beta ~ -det(c, d, a) for s_c > s_d, signs
// turned for s_c < s_d. The faces meet beyond v exactly when alpha and beta are >= 0.
bool faces_at_vertex_meet(const Point3& v, const Point3& a, const Point3& b, const Point3& c,
                          const Point3& d) {
  const Plane f(v, a, b);
  const int sc = f.side(c), sd = f.side(d);
  if (sc * sd > 0) return false;
  if (sc == 0 && sd == 0) return coplanar_cones_meet(v, a, b, c, d);
  const Plane g(v, c, d);
  const int sa = g.side(a), sb = g.side(b);
  if (sa == 0 && sb == 0) return false;  // (v, c, d) is degenerate: a plane has f on both its sides
  const int s = sc > sd ? 1 : -1;
  return s * sb >= 0 && s * sa <= 0;
}

// Faces (u, v, x) and (u, v, y).
bool faces_at_edge_fold(const Point3& u, const Point3& v, const Point3& x, const Point3& y) {
  if (orient3d(u, v, x, y) != 0) return false;
  const Projection p = project(u, v, x);
  return p.turn != 0 && turn(p.axis, u, v, y) == p.turn;
}

}  // namespace

bool triangles_intersect(const Triangle& f, const Triangle& g) {
  // Which corners of f are corners of g, and the other way round.
  unsigned in_f = 0, in_g = 0;
  for (unsigned i = 0; i < 3; ++i) {
    for (unsigned j = 0; j < 3; ++j) {
      const bool same = f.vertex[i] == g.vertex[j];
      in_f |= static_cast<unsigned>(same) << i;
      in_g |= static_cast<unsigned>(same) << j;
    }
  }
  const Point3 *p = f.corner, *q = g.corner;
  if (in_f == 0) return disjoint_faces_meet(p, q);
  // Masks of one bit name the common corner, of two bits the apex: the missing bit.
  constexpr int kIndex[8] = {0, 0, 1, 2, 2, 1, 0, 0};
  constexpr bool kOneBit[8] = {false, true, true, false, true, false, false, false};
  if (in_f == 7 && in_g == 7) return !collinear(p[0], p[1], p[2]) && !collinear(q[0], q[1], q[2]);
  const int i = kIndex[in_f], j = kIndex[in_g];
  if (kOneBit[in_f] && kOneBit[in_g]) {
    return faces_at_vertex_meet(p[i], p[(i + 1) % 3], p[(i + 2) % 3], q[(j + 1) % 3],
                                q[(j + 2) % 3]);
  }
  if (kOneBit[in_f] != kOneBit[in_g] || in_f == 7 || in_g == 7) return false;  // repeated ids
  return faces_at_edge_fold(p[(i + 1) % 3], p[(i + 2) % 3], p[i], q[j]);
}

}  // namespace plc
