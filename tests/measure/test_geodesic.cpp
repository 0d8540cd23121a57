#include "engine/measure/geodesic.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "tests/samples/sample_shapes.h"

namespace {

using samples::Soup;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<double> distances(const Soup& m, uint32_t source,
                              const plc::Executor& executor = plc::SerialExecutor()) {
  std::vector<double> d(m.vertex_count(), -1);
  plc::geodesic_distances(m.arrays(), source, executor, d.data());
  return d;
}

uint32_t vertex_at(const Soup& m, double x, double y, double z) {
  const double point[3] = {x, y, z};
  return static_cast<uint32_t>(plc::nearest_vertex(m.arrays(), point));
}

double apart(const Soup& m, size_t a, size_t b) {
  double sum = 0;
  for (size_t k = 0; k < 3; ++k) {
    const double off = m.xyz[3 * a + k] - m.xyz[3 * b + k];
    sum += off * off;
  }
  return std::sqrt(sum);
}

// The surface of [0, 1]^3 with n x n squares per face, welded; n > 0.
Soup fine_cube(uint32_t n) {
  Soup m;
  std::map<std::array<uint32_t, 3>, uint32_t> ids;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const uint32_t side : {0U, n}) {
      const auto id = [&](uint32_t i, uint32_t j) {
        std::array<uint32_t, 3> p{};
        p[axis] = side;
        p[(axis + 1) % 3] = side == 0 ? j : i;
        p[(axis + 2) % 3] = side == 0 ? i : j;
        const auto [it, fresh] = ids.try_emplace(p, 0U);
        if (fresh) it->second = m.vertex(double(p[0]) / n, double(p[1]) / n, double(p[2]) / n);
        return it->second;
      };
      for (uint32_t i = 0; i < n; ++i) {
        for (uint32_t j = 0; j < n; ++j) {
          m.face(id(i, j), id(i + 1, j), id(i + 1, j + 1));
          m.face(id(i, j), id(i + 1, j + 1), id(i, j + 1));
        }
      }
    }
  }
  return m;
}

// Every edge of `m` gets a vertex in its middle, which stays where it is: the same polyhedron.
Soup divided(const Soup& m) {
  Soup out;
  out.xyz = m.xyz;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [it, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, 0U);
    if (fresh) {
      const double *p = m.xyz.data() + 3 * a, *q = m.xyz.data() + 3 * b;
      it->second = out.vertex((p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2);
    }
    return it->second;
  };
  for (size_t i = 0; i < m.abc.size(); i += 3) {
    const uint32_t a = m.abc[i], b = m.abc[i + 1], c = m.abc[i + 2];
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    out.face(a, ab, ca);
    out.face(ab, b, bc);
    out.face(ca, bc, c);
    out.face(ab, bc, ca);
  }
  return out;
}

Soup bumpy_sphere(int levels, unsigned seed, double height) {
  Soup m = samples::sphere(levels);
  std::mt19937 bits(seed);
  std::normal_distribution<double> normal;
  for (size_t i = 0; i < m.xyz.size(); i += 3) {
    const double scale = 1 + height * normal(bits);
    for (size_t k = 0; k < 3; ++k) m.xyz[i + k] *= scale;
  }
  return m;
}

}  // namespace

TEST_CASE("on a sphere the distances converge to the great circles with order two", "[geodesic]") {
  std::vector<double> sizes, errors;
  for (int level = 2; level < 6; ++level) {
    const Soup m = samples::sphere(level);
    const std::vector<double> d = distances(m, 0);  // from (1, 0, 0)
    double worst = 0;
    for (size_t v = 0; v < d.size(); ++v) {
      const double* p = m.xyz.data() + 3 * v;
      const double arc = std::atan2(std::hypot(p[1], p[2]), p[0]);
      worst = std::max(worst, std::abs(d[v] - arc));
      CHECK(d[v] <= arc + 1e-12);  // the polyhedron is inside
    }
    sizes.push_back(std::pow(2, -level));
    errors.push_back(worst);
  }
  CHECK(samples::order_of(sizes, errors) == Approx(2).margin(0.15));
  CHECK(errors.back() < 0.002);
}

TEST_CASE("on a flat sheet the distances are straight lines, from any vertex", "[geodesic]") {
  const Soup m = samples::turned(samples::sheet(13, 0.5));
  for (const uint32_t source : {0U, 6U, 97U, 195U}) {
    const std::vector<double> d = distances(m, source);
    for (size_t v = 0; v < d.size(); ++v) CHECK(std::abs(d[v] - apart(m, source, v)) < 1e-14);
  }
}

TEST_CASE("on a large sheet of thin or slanted triangles the distances are straight lines",
          "[geodesic]") {
  for (const double slant : {0.0, 60.0}) {
    Soup m = samples::sheet(60, 0);
    for (size_t i = 0; i < m.xyz.size(); i += 3) {
      m.xyz[i] = 40 * m.xyz[i] + slant * m.xyz[i + 1];
    }
    const std::vector<double> d = distances(m, 5 * 61 + 7);
    for (size_t v = 0; v < d.size(); ++v) {
      CHECK(std::abs(d[v] - apart(m, 5 * 61 + 7, v)) < 1e-12);
    }
  }
}

TEST_CASE("on a sheet of random obtuse triangles the distances are straight lines", "[geodesic]") {
  Soup m = samples::sheet(16, 0);
  std::mt19937 bits(3);
  std::uniform_real_distribution<double> offset(-0.015, 0.015);
  for (uint32_t j = 1; j < 16; ++j) {
    for (uint32_t i = 1; i < 16; ++i) {
      m.xyz[3 * (j * 17 + i)] += offset(bits);
      m.xyz[3 * (j * 17 + i) + 1] += offset(bits);
    }
  }
  for (size_t i = 0; i < m.xyz.size(); i += 3) m.xyz[i] *= 12;  // angles near 180 degrees
  const std::vector<double> d = distances(m, 8 * 17 + 8);
  for (size_t v = 0; v < d.size(); ++v) CHECK(std::abs(d[v] - apart(m, 8 * 17 + 8, v)) < 1e-13);
}

TEST_CASE("across the edges of a cube the distances are straight when unfolded", "[geodesic]") {
  for (const uint32_t n : {1U, 4U, 9U}) {
    const Soup m = fine_cube(n);
    // From the corner 0 to (1, y, z): over the edge of z = 0 or of y = 0, whichever is nearer.
    const std::vector<double> d = distances(m, vertex_at(m, 0, 0, 0));
    for (size_t v = 0; v < d.size(); ++v) {
      const double* p = m.xyz.data() + 3 * v;
      double want = kInfinity;
      for (size_t a = 0; a < 3; ++a) {
        const double u = p[a], s = p[(a + 1) % 3], t = p[(a + 2) % 3];
        if (s == 0) want = std::min(want, std::hypot(u, t));
        if (u == 1) want = std::min({want, std::hypot(1 + s, t), std::hypot(1 + t, s)});
      }
      CHECK(d[v] == Approx(want).epsilon(1e-14));
    }
  }
}

TEST_CASE("a division of the faces changes no distance", "[geodesic]") {
  // Exactly what an approximation over faces does not do.
  for (const unsigned seed : {1U, 2U, 3U}) {
    const Soup coarse = bumpy_sphere(3, seed, 0.1);
    const Soup fine = divided(divided(coarse));
    for (const uint32_t source : {0U, 100U, 257U}) {
      const std::vector<double> a = distances(coarse, source), b = distances(fine, source);
      for (size_t v = 0; v < a.size(); ++v) CHECK(std::abs(a[v] - b[v]) < 1e-12);
    }
  }
}

TEST_CASE("a division of a rough terrain with a hole changes no distance", "[geodesic]") {
  std::mt19937 bits(8);
  std::uniform_real_distribution<double> height(0, 0.15);
  Soup coarse = samples::sheet(14, 0);
  for (size_t i = 2; i < coarse.xyz.size(); i += 3) coarse.xyz[i] = height(bits);
  coarse.abc.erase(coarse.abc.begin() + 6 * (14 * 6 + 5), coarse.abc.begin() + 6 * (14 * 6 + 9));
  const Soup fine = divided(coarse);
  for (const uint32_t source : {0U, 107U, 224U}) {
    const std::vector<double> a = distances(coarse, source), b = distances(fine, source);
    for (size_t v = 0; v < a.size(); ++v) CHECK(std::abs(a[v] - b[v]) < 1e-12);
  }
}

TEST_CASE("distances are the same both ways and obey the triangle inequality", "[geodesic]") {
  const Soup m = bumpy_sphere(2, 5, 0.2);
  std::vector<std::vector<double>> d;
  for (uint32_t v = 0; v < m.vertex_count(); ++v) d.push_back(distances(m, v));
  for (size_t a = 0; a < d.size(); ++a) {
    for (size_t b = 0; b < d.size(); ++b) {
      CHECK(std::abs(d[a][b] - d[b][a]) < 1e-12);
      CHECK(d[a][b] >= apart(m, a, b) - 1e-12);
      for (size_t c = 0; c < d.size(); c += 7) CHECK(d[a][b] <= d[a][c] + d[c][b] + 1e-12);
    }
  }
}

TEST_CASE("distances that swallow others went round and round a far vertex", "[geodesic]") {
  // Vertex 10 is 1e43 away from the others: what is added to a path by way of it is lost.
  Soup m;
  m.xyz = {2.5,      0,         0,
           2,        0,         0.5,
           1.5,      0,         6.1,
           2,        0,         -0.5,
           0.77,     2.38,      0,
           0.62,     1.9,       0.5,
           0.46,     1.43,      0,
           0.62,     1.9,       -0.5,
           -2.02,    1.47,      0,
           -1.62,    1.18,      0.5,
           -1.21353, 0.881678,  -1.57771e+43,
           11.0271,  1.17557,   -0.5,
           -2.02254, -1.46946,  0,
           -1.61803, -1.17557,  1.5,
           -1.21353, -0.881678, 6.12323e-17,
           -1.61803, -1.17557,  -0.5,
           0.772542, -2.37764,  0,
           0.618034, -1.90211,  0.5,
           0.463525, -1.42658,  0,
           0.618034, -1.90211,  -0.5};
  m.abc = {5, 9, 10, 5, 10, 6, 6, 10, 11, 9, 14, 10, 10, 14, 15, 10, 15, 11, 15, 16, 12, 19, 0, 16};
  for (uint32_t source = 0; source < 20; ++source) {
    const std::vector<double> d = distances(m, source);
    CHECK(d[source] == 0);
    if (std::isfinite(d[10]) && source != 10) CHECK(d[10] == Approx(1.57771e43));
  }
}

TEST_CASE("paths bend around a hole and a notch", "[geodesic]") {
  // 3 x 3 squares without the middle one: from corner to corner around a corner of the hole.
  Soup m = samples::sheet(3, 0);
  m.abc.erase(m.abc.begin() + 4 * 6, m.abc.begin() + 5 * 6);
  const std::vector<double> d = distances(m, 0);
  const double s = 1.0 / 3;
  CHECK(d[15] == Approx(2 * s * std::sqrt(5.0)).epsilon(1e-14));
  CHECK(d[10] == Approx(s + s * std::sqrt(5.0)).epsilon(1e-14));
  CHECK(d[5] == Approx(s * std::sqrt(2.0)).epsilon(1e-14));
}

TEST_CASE("what no path leads to is infinitely far", "[geodesic]") {
  Soup m = samples::cube();
  m.append(samples::moved(samples::cube(), 5, 0, 0));
  m.vertex(9, 9, 9);
  const std::vector<double> d = distances(m, 8);
  for (size_t v = 0; v < 8; ++v) CHECK(d[v] == kInfinity);
  for (size_t v = 8; v < 16; ++v) CHECK(d[v] < 3);
  CHECK(d[16] == kInfinity);
  const std::vector<double> alone = distances(m, 16);
  CHECK(alone[16] == 0);
  CHECK(alone[0] == kInfinity);
}

TEST_CASE("paths pass through a common vertex and over an edge of four faces", "[geodesic]") {
  Soup m;  // two tetrahedra with vertex 0 in common
  m.xyz = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1};
  m.abc = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3, 0, 4, 5, 0, 6, 4, 0, 5, 6, 4, 6, 5};
  CHECK(distances(m, 1)[4] == Approx(2).epsilon(1e-15));
  Soup fins;  // squares at the z axis, of which the path takes two
  for (const double x : {0.0, 1.0, -1.0}) {
    fins.vertex(x, 0, 0);
    fins.vertex(x, 0, 1);
  }
  fins.vertex(0, 1, 0);
  fins.vertex(0, 1, 1);
  for (const uint32_t v : {2U, 4U, 6U}) {
    fins.face(0, v, v + 1);
    fins.face(0, v + 1, 1);
  }
  const std::vector<double> d = distances(fins, 2);
  CHECK(d[5] == Approx(std::sqrt(5.0)).epsilon(1e-14));
  CHECK(d[7] == Approx(std::sqrt(5.0)).epsilon(1e-14));
}

TEST_CASE("faces of no area and faces turned over do not stop paths", "[geodesic]") {
  Soup m = samples::sheet(4, 0);
  for (size_t i = 0; i < m.abc.size(); i += 9) std::swap(m.abc[i], m.abc[i + 1]);
  const uint32_t extra = m.vertex(0.5, 0.375, 0);  // in an edge, by two faces without area
  m.face(7, extra, 12);
  m.face(3, 3, 4);
  const std::vector<double> d = distances(m, 0);
  for (size_t v = 0; v < 25; ++v) CHECK(d[v] == Approx(apart(m, 0, v)).epsilon(1e-14));
}

TEST_CASE("far from the origin distances lose what rounding of positions costs", "[geodesic]") {
  const Soup near = samples::torus(24, 16, 2, 0.7);
  const Soup far = samples::moved(near, 1048576, -524288, 1048576);
  const std::vector<double> a = distances(near, 5), b = distances(far, 5);
  for (size_t v = 0; v < a.size(); ++v) CHECK(std::abs(a[v] - b[v]) < 1e-8);
}

TEST_CASE("ties on a symmetric mesh come out the same, for any executor", "[geodesic]") {
  const Soup m = samples::sphere(4);
  const std::vector<double> a = distances(m, 0), b = distances(m, 0, samples::ReverseExecutor());
  CHECK(a == b);
  CHECK(distances(m, 2)[3] == Approx(a[1]).epsilon(1e-13));  // another axis
}

TEST_CASE("the nearest vertex is one of a face, the first of equal ones", "[geodesic]") {
  Soup m;
  m.vertex(0.4, 0.5, 0.5);  // of no face
  m.append(samples::cube());
  CHECK(vertex_at(m, 0.9, 0.8, 0.1) == 4);
  CHECK(vertex_at(m, 0.5, 0.5, 0.5) == 1);
}
