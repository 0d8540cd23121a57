// Exact orientation predicates by expansion arithmetic (Shewchuk 1997; theorem numbers are his).
//
// An expansion is a sum of doubles that do not overlap, smallest first, without zeros; no component
// is the number 0. Products and minors are nonadjacent, scale() keeps that (theorem 19), and sum()
// makes strongly nonoverlapping expansions of such (theorem 13). Nothing but sum() is applied to a
// result of sum(), so that every step stays within what is proven.
#include "engine/exact/predicates.h"

#include <algorithm>

#include "pyramid/two_doubles.h"

namespace plc {
namespace {

template <int N>
struct Expansion {
  double c[N];
  int n = 0;
  void push(double value) {
    if (value != 0) c[n++] = value;
  }
  int sign() const { return n == 0 ? 0 : (c[n - 1] > 0 ? 1 : -1); }
};

// a d - b c. Two expansions of two components, added by growing (theorem 12).
Expansion<4> minor2(double a, double b, double c, double d) {
  const TwoDoubles p = two_product(a, d), q = two_product(b, c);
  const TwoDoubles s0 = two_sum(p.lo, -q.lo);
  const TwoDoubles s1 = two_sum(p.hi, s0.hi);
  const TwoDoubles t1 = two_sum(s1.lo, -q.hi);
  const TwoDoubles t2 = two_sum(s1.hi, t1.hi);
  Expansion<4> h;
  h.push(s0.lo);
  h.push(t1.lo);
  h.push(t2.lo);
  h.push(t2.hi);
  return h;
}

template <int N>
Expansion<2 * N> scale(const Expansion<N>& e, double b) {
  Expansion<2 * N> h;
  if (e.n == 0 || b == 0) return h;
  TwoDoubles q = two_product(e.c[0], b);
  h.push(q.lo);
  for (int i = 1; i < e.n; ++i) {
    const TwoDoubles t = two_product(e.c[i], b);
    const TwoDoubles s = two_sum(q.hi, t.lo);
    h.push(s.lo);
    q = fast_two_sum(t.hi, s.hi);
    h.push(q.lo);
  }
  h.push(q.hi);
  return h;
}

template <int M, int N>
Expansion<M + N> sum(const Expansion<M>& e, const Expansion<N>& f) {
  Expansion<M + N> h;
  int i = 0, j = 0;
  const auto next = [&] {
    const bool from_e = j == f.n || (i < e.n && std::abs(e.c[i]) <= std::abs(f.c[j]));
    return from_e ? e.c[i++] : f.c[j++];
  };
  const int total = e.n + f.n;
  if (total == 0) return h;
  double q = next();
  for (int k = 1; k < total; ++k) {
    const TwoDoubles t = two_sum(q, next());
    h.push(t.lo);
    q = t.hi;
  }
  h.push(q);
  return h;
}

bool exact_difference(double a, double b) {
  return two_sum(a, -b).lo == 0;
}

bool exact_difference(const Point3& a, const Point3& b) {
  return exact_difference(a.x, b.x) && exact_difference(a.y, b.y) && exact_difference(a.z, b.z);
}

// det(u, v, w), the vectors exact.
int determinant_sign(const Point3& u, const Point3& v, const Point3& w) {
  const auto x = scale(minor2(v.x, v.y, w.x, w.y), u.z);
  const auto y = scale(minor2(w.x, w.y, u.x, u.y), v.z);
  const auto z = scale(minor2(u.x, u.y, v.x, v.y), w.z);
  return sum(sum(x, y), z).sign();
}

}  // namespace

int orient3d_exact(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  // The usual case of coordinates that were floats or that lie on a grid: 24 components at most.
  if (exact_difference(b, a) && exact_difference(c, a) && exact_difference(d, a)) {
    return determinant_sign({b.x - a.x, b.y - a.y, b.z - a.z}, {c.x - a.x, c.y - a.y, c.z - a.z},
                            {d.x - a.x, d.y - a.y, d.z - a.z});
  }
  // [bcd] - [acd] + [abd] - [abc], multiplied out: each minor of x and y of two points times the z
  // of the two others.
  const auto ab = minor2(a.x, a.y, b.x, b.y), ac = minor2(a.x, a.y, c.x, c.y);
  const auto ad = minor2(a.x, a.y, d.x, d.y), bc = minor2(b.x, b.y, c.x, c.y);
  const auto bd = minor2(b.x, b.y, d.x, d.y), cd = minor2(c.x, c.y, d.x, d.y);
  const auto bcd = sum(sum(scale(cd, b.z), scale(bd, -c.z)), scale(bc, d.z));
  const auto acd = sum(sum(scale(cd, -a.z), scale(ad, c.z)), scale(ac, -d.z));
  const auto abd = sum(sum(scale(bd, a.z), scale(ad, -b.z)), scale(ab, d.z));
  const auto abc = sum(sum(scale(bc, -a.z), scale(ac, b.z)), scale(ab, -c.z));
  return sum(sum(bcd, acd), sum(abd, abc)).sign();
}

int orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) {
  // [ab] + [bc] + [ca]
  const auto ab = minor2(ax, ay, bx, by);
  const auto bc = minor2(bx, by, cx, cy);
  const auto ca = minor2(cx, cy, ax, ay);
  return sum(sum(ab, bc), ca).sign();
}

bool collinear(const Point3& a, const Point3& b, const Point3& c) {
  return orient2d(a.x, a.y, b.x, b.y, c.x, c.y) == 0 &&
         orient2d(a.y, a.z, b.y, b.z, c.y, c.z) == 0 && orient2d(a.z, a.x, b.z, b.x, c.z, c.x) == 0;
}

}  // namespace plc
