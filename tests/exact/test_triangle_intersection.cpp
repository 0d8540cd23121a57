#include "engine/exact/triangle_intersection.h"

#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

namespace {

using plc::Point3;
using plc::Triangle;

// An independent answer for small integer coordinates: the intersection of the triangles as a
// convex polygon, by clipping one with the plane and the edges of the other in exact rationals.
using Int = __int128;
struct Rational3 {
  Int x, y, z, w;  // (x, y, z) / w, w > 0
};
using Grid3 = std::array<int, 3>;
using GridTriangle = std::array<Grid3, 3>;

Int gcd(Int a, Int b) {
  a = a < 0 ? -a : a;
  b = b < 0 ? -b : b;
  while (b != 0) {
    const Int r = a % b;
    a = b;
    b = r;
  }
  return a;
}

// nx x + ny y + nz z + e
struct Form {
  Int nx, ny, nz, e;
  Int at(const Rational3& p) const { return nx * p.x + ny * p.y + nz * p.z + e * p.w; }
};

Form form(const Grid3& normal, const Grid3& through) {
  Form f{normal[0], normal[1], normal[2], 0};
  f.e = -(f.nx * through[0] + f.ny * through[1] + f.nz * through[2]);
  return f;
}

Grid3 difference(const Grid3& a, const Grid3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Grid3 cross(const Grid3& a, const Grid3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Grid3 normal_of(const GridTriangle& t) {
  return cross(difference(t[1], t[0]), difference(t[2], t[0]));
}

Rational3 crossing(const Rational3& p, Int sp, const Rational3& q, Int sq) {
  // sp > 0 > sq
  Rational3 r{sp * q.x - sq * p.x, sp * q.y - sq * p.y, sp * q.z - sq * p.z, sp * q.w - sq * p.w};
  const Int g = gcd(gcd(r.x, r.y), gcd(r.z, r.w));
  return {r.x / g, r.y / g, r.z / g, r.w / g};
}

// What of the convex polygon lies where the form is >= 0, or == 0.
std::vector<Rational3> clip(const std::vector<Rational3>& polygon, const Form& f, bool equal) {
  std::vector<Rational3> kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const Rational3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const Int sp = f.at(p), sq = f.at(q);
    if (sp == 0 || (sp > 0 && !equal)) kept.push_back(p);
    if (sp > 0 && sq < 0) kept.push_back(crossing(p, sp, q, sq));
    if (sp < 0 && sq > 0) kept.push_back(crossing(q, sq, p, sp));
  }
  return kept;
}

std::vector<Rational3> intersection(const GridTriangle& f, const GridTriangle& g) {
  std::vector<Rational3> polygon;
  for (const Grid3& p : f) polygon.push_back({p[0], p[1], p[2], 1});
  const Grid3 n = normal_of(g);
  polygon = clip(polygon, form(n, g[0]), true);
  for (size_t k = 0; k < 3; ++k) {
    polygon = clip(polygon, form(cross(n, difference(g[(k + 1) % 3], g[k])), g[k]), false);
  }
  return polygon;
}

bool is_flat(const GridTriangle& t) {
  return normal_of(t) == Grid3{0, 0, 0};
}

bool on_line(const Rational3& p, const Grid3& a, const Grid3& b) {
  const Int dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
  const Int x = p.x - a[0] * p.w, y = p.y - a[1] * p.w, z = p.z - a[2] * p.w;
  return dx * y == dy * x && dy * z == dz * y && dz * x == dx * z;
}

bool expected(const GridTriangle& f, const std::array<uint32_t, 3>& fi, const GridTriangle& g,
              const std::array<uint32_t, 3>& gi) {
  if (is_flat(f) || is_flat(g)) return false;
  std::vector<Grid3> common;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      if (fi[i] == gi[j]) common.push_back(f[i]);
    }
  }
  for (const Rational3& p : intersection(f, g)) {
    if (common.empty() || common.size() == 3) return true;
    if (common.size() == 1) {
      const Grid3& v = common[0];
      if (p.x != v[0] * p.w || p.y != v[1] * p.w || p.z != v[2] * p.w) return true;
    } else if (!on_line(p, common[0], common[1])) {
      return true;
    }
  }
  return false;
}

Triangle to_triangle(const GridTriangle& t, const std::array<uint32_t, 3>& ids) {
  Triangle r{};
  for (size_t k = 0; k < 3; ++k) {
    r.corner[k] = {static_cast<double>(t[k][0]), static_cast<double>(t[k][1]),
                   static_cast<double>(t[k][2])};
    r.vertex[k] = ids[k];
  }
  return r;
}

// Both the answer and its independence of the order of the faces and of their corners.
bool agrees(const GridTriangle& f, const std::array<uint32_t, 3>& fi, const GridTriangle& g,
            const std::array<uint32_t, 3>& gi, unsigned variant) {
  const bool want = expected(f, fi, g, gi);
  Triangle a = to_triangle(f, fi), b = to_triangle(g, gi);
  const unsigned ra = variant % 3, rb = variant / 3 % 3;
  std::rotate(a.corner, a.corner + ra, a.corner + 3);
  std::rotate(a.vertex, a.vertex + ra, a.vertex + 3);
  std::rotate(b.corner, b.corner + rb, b.corner + 3);
  std::rotate(b.vertex, b.vertex + rb, b.vertex + 3);
  if ((variant & 1U) != 0) std::swap(a.corner[0], a.corner[1]), std::swap(a.vertex[0], a.vertex[1]);
  if ((variant & 2U) != 0) std::swap(b.corner[0], b.corner[1]), std::swap(b.vertex[0], b.vertex[1]);
  return plc::triangles_intersect(a, b) == want && plc::triangles_intersect(b, a) == want;
}

std::vector<Grid3> grid_points(int nx, int ny, int nz) {
  std::vector<Grid3> points;
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) points.push_back({x, y, z});
    }
  }
  return points;
}

using Ids = std::array<uint32_t, 3>;

std::vector<Ids> all_triangles(uint32_t points) {
  std::vector<Ids> triangles;
  for (uint32_t a = 0; a < points; ++a) {
    for (uint32_t b = a + 1; b < points; ++b) {
      for (uint32_t c = b + 1; c < points; ++c) triangles.push_back({a, b, c});
    }
  }
  return triangles;
}

// Every pair of triangles over the points: with common vertices as such, and with copies of them.
void check_all_pairs(const std::vector<Grid3>& points, unsigned step) {
  const auto at = [&](const Ids& t) {
    return GridTriangle{points[t[0]], points[t[1]], points[t[2]]};
  };
  const std::vector<Ids> triangles = all_triangles(static_cast<uint32_t>(points.size()));
  unsigned variant = 0;
  size_t wrong = 0, pairs = 0;
  for (size_t i = 0; i < triangles.size(); ++i) {
    for (size_t j = i + variant % step; j < triangles.size(); j += step, ++variant) {
      const Ids &f = triangles[i], &g = triangles[j];
      const Ids copies = {g[0] + 1000, g[1] + 1000, g[2] + 1000};
      wrong += agrees(at(f), f, at(g), g, variant) ? 0 : 1;
      wrong += agrees(at(f), f, at(g), copies, variant / 2) ? 0 : 1;
      ++pairs;
    }
  }
  CHECK(pairs > 1000);
  CHECK(wrong == 0);
}

plc::Float4 packed(float x, float y, float z) {
  return {x, y, z, 0};
}

}  // namespace

TEST_CASE("all pairs of triangles in a plane grid are judged as by exact clipping",
          "[triangle_intersection]") {
  check_all_pairs(grid_points(4, 3, 1), 1);
}

TEST_CASE("all pairs of triangles in a 3 x 2 x 2 grid are judged as by exact clipping",
          "[triangle_intersection]") {
  check_all_pairs(grid_points(3, 2, 2), 1);
}

TEST_CASE("pairs of triangles in a 3 x 3 x 3 grid are judged as by exact clipping",
          "[triangle_intersection]") {
  check_all_pairs(grid_points(3, 3, 3), 23);
}

TEST_CASE("random pairs on larger grids are judged as by exact clipping",
          "[triangle_intersection]") {
  std::mt19937 bits(7);
  size_t wrong = 0;
  for (unsigned i = 0; i < 30000; ++i) {
    const unsigned size = 3 + i % 7;
    const auto point = [&] {
      return Grid3{static_cast<int>(bits() % size), static_cast<int>(bits() % size),
                   static_cast<int>(bits() % size)};
    };
    GridTriangle f{point(), point(), point()}, g{point(), point(), point()};
    const size_t common = i % 4 == 3 ? 0 : i % 4;
    Ids gi = {4, 5, 6};
    for (uint32_t k = 0; k < common; ++k) {
      g[k] = f[k];
      gi[k] = k + 1;
    }
    wrong += agrees(f, {1, 2, 3}, g, gi, i / 4) ? 0 : 1;
  }
  CHECK(wrong == 0);
}

TEST_CASE("faces across an edge meet only when one is folded back onto the other",
          "[triangle_intersection]") {
  const plc::Float4 p[] = {packed(0, 0, 0),  packed(1, 0, 0),      packed(0, 1, 0),
                           packed(0, -1, 0), packed(0.3F, 2, 0),   packed(0.3F, 2, 1e-30F),
                           packed(0, 1, 0),  packed(1, -3, 1e-3F), packed(5, 0, 0)};
  const uint32_t face[3] = {0, 1, 2};
  const auto with_apex = [&](uint32_t apex) {
    const uint32_t other[3] = {1, 0, apex};
    return plc::faces_intersect(p, face, other);
  };
  CHECK_FALSE(with_apex(3));
  CHECK(with_apex(4));
  CHECK_FALSE(with_apex(5));  // folded, but not quite onto it
  CHECK(with_apex(6));        // another vertex at the same place
  CHECK_FALSE(with_apex(7));
  CHECK_FALSE(with_apex(8));  // zero area
}

TEST_CASE("a face of zero area meets nothing", "[triangle_intersection]") {
  const Triangle face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {0, 1, 2}};
  const Triangle needle{{{1, 1, -1}, {1, 1, 0}, {1, 1, 1}}, {3, 4, 5}};
  const Triangle point{{{1, 1, 0}, {1, 1, 0}, {1, 1, 0}}, {3, 4, 5}};
  const Triangle within{{{0, 0, 0}, {1, 1, 0}, {2, 2, 0}}, {0, 4, 5}};
  const Triangle repeated{{{0, 0, 0}, {0, 0, 0}, {4, 0, 0}}, {0, 0, 1}};
  for (const Triangle& flat : {needle, point, within, repeated}) {
    CHECK_FALSE(plc::triangles_intersect(face, flat));
    CHECK_FALSE(plc::triangles_intersect(flat, face));
    CHECK_FALSE(plc::triangles_intersect(flat, flat));
  }
}

TEST_CASE("two faces on the same three vertices always meet", "[triangle_intersection]") {
  const Triangle face{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {0, 1, 2}};
  const Triangle turned{{{4, 0, 0}, {0, 0, 0}, {0, 4, 0}}, {1, 0, 2}};
  CHECK(plc::triangles_intersect(face, turned));
}

TEST_CASE("boxes that share a boundary point overlap", "[triangle_intersection]") {
  const plc::FaceBox unit = plc::face_box(packed(0, 0, 0), packed(1, 1, 0), packed(1, 0, 1));
  const plc::FaceBox touching = plc::face_box(packed(1, 1, 1), packed(2, 1, 1), packed(2, 3, 4));
  const plc::FaceBox apart = plc::face_box(packed(0, 0, 1.5F), packed(1, 1, 2), packed(1, 0, 3));
  CHECK(plc::boxes_overlap(unit, touching));
  CHECK(plc::boxes_overlap(touching, unit));
  CHECK_FALSE(plc::boxes_overlap(unit, apart));
  CHECK_FALSE(plc::boxes_overlap(apart, unit));
}
