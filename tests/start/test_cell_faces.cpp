#include "engine/start/cell_faces.h"

#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch.hpp>
#include <map>
#include <utility>
#include <vector>

#include "engine/start/iso_surface.h"

namespace {

using plc::CellFaces;
using Face = std::array<uint8_t, 3>;
using Vector3 = std::array<double, 3>;

double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vector3 place(uint8_t vertex, double t) {
  Vector3 p{};
  for (uint32_t a = 0; a < 3; ++a) {
    p[a] = static_cast<double>(CellFaces::corner(vertex) >> a & 1) +
           t * static_cast<double>(CellFaces::direction(vertex) >> a & 1);
  }
  return p;
}

// A linear function of places is largest, and smallest, where vertices are as far along their edges
// as they may be, and so is one that is linear in the place of each.
constexpr std::array<double, 2> kEnds{plc::kIsoMargin, 1 - plc::kIsoMargin};
constexpr double kRounding = 1e-9;

double largest(const std::vector<uint8_t>& vertices, const Vector3& n) {
  double most = -10;
  for (const uint8_t v : vertices) {
    for (const double t : kEnds) most = std::max(most, dot(n, place(v, t)));
  }
  return most;
}

const std::vector<Vector3>& directions() {
  static const std::vector<Vector3> all = [] {
    std::vector<Vector3> some;
    for (const double x : {-2, -1, 0, 1, 2}) {
      for (const double y : {-2, -1, 0, 1, 2}) {
        for (const double z : {-2, -1, 0, 1, 2}) some.push_back({x, y, z});
      }
    }
    return some;
  }();
  return all;
}

// The area vector of a face along n, with each vertex at either end, is positive.
bool faces_along(const Face& f, const Vector3& n) {
  for (size_t i = 0; i < 8; ++i) {
    Vector3 p[3];
    for (size_t k = 0; k < 3; ++k) p[k] = place(f[k], kEnds[i >> k & 1]);
    Vector3 u{}, w{};
    for (size_t a = 0; a < 3; ++a) u[a] = p[1][a] - p[0][a], w[a] = p[2][a] - p[0][a];
    const Vector3 area{u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2],
                       u[0] * w[1] - u[1] * w[0]};
    if (dot(area, n) <= kRounding) return false;
  }
  return true;
}

// A direction shows that two faces meet in what they share and in nothing else, wherever their
// vertices are.
bool are_apart(const Face& f, const Face& g) {
  std::vector<uint8_t> shared, of_f, of_g;
  for (const uint8_t v : f) {
    (std::find(g.begin(), g.end(), v) != g.end() ? shared : of_f).push_back(v);
  }
  for (const uint8_t v : g) {
    if (std::find(f.begin(), f.end(), v) == f.end()) of_g.push_back(v);
  }
  return std::any_of(directions().begin(), directions().end(), [&](Vector3 n) {
    // Seen from there, both show the same side: they do not lie on each other.
    if (shared.size() == 2) return faces_along(f, n) && faces_along(g, n);
    // A plane between them, through what they share, which at most one touches elsewhere.
    Vector3 back = n;
    for (double& c : back) c = -c;
    const double low = largest(of_f, n), high = -largest(of_g, back);
    if (shared.empty()) return low < high - kRounding;
    return std::all_of(kEnds.begin(), kEnds.end(), [&](double t) {
      const double at = dot(n, place(shared[0], t));
      return low <= at + kRounding && high >= at - kRounding && low < high - kRounding;
    });
  });
}

std::vector<Face> faces_of(const CellFaces& cell, uint32_t inside) {
  return {cell.faces.begin() + cell.first[inside], cell.faces.begin() + cell.first[inside + 1]};
}

// The sides of the cell that a vertex lies in, bit a: the near one of axis a, bit 3 + a: the far
// one.
uint32_t sides_of(uint8_t v) {
  const uint32_t on = ~CellFaces::direction(v) & 7U, corner = CellFaces::corner(v);
  return (on & ~corner) | (on & corner) << 3;
}

using Edge = std::pair<uint8_t, uint8_t>;

// Edges of the case's faces by how often they are there; those there and back are none.
std::map<Edge, int> border_of(const CellFaces& cell, uint32_t inside) {
  std::map<Edge, int> edges;
  for (const Face& f : faces_of(cell, inside)) {
    for (size_t k = 0; k < 3; ++k) {
      const Edge back{f[(k + 1) % 3], f[k]};
      if (edges.erase(back) == 0) ++edges[{f[k], f[(k + 1) % 3]}];
    }
  }
  return edges;
}

}  // namespace

TEST_CASE("wherever vertices are on their edges, faces of a cell do not meet", "[cell_faces]") {
  for (uint32_t inside = 0; inside < CellFaces::kCases; ++inside) {
    CAPTURE(inside);
    const std::vector<Face> faces = faces_of(plc::cube_faces(), inside);
    bool apart = true;
    for (size_t i = 0; i < faces.size(); ++i) {
      for (size_t j = 0; j < i; ++j) apart = apart && are_apart(faces[i], faces[j]);
    }
    CHECK(apart);
  }
}

TEST_CASE("borders of a cell's faces lie in its sides, and are those of the next cell",
          "[cell_faces]") {
  for (const CellFaces* cell : {&plc::tetrahedron_faces(), &plc::cube_faces()}) {
    for (uint32_t inside = 0; inside < CellFaces::kCases; ++inside) {
      CAPTURE(inside, cell->directions);
      std::vector<int> used(64, 0);
      for (const Face& f : faces_of(*cell, inside)) {
        for (const uint8_t v : f) used[v] = 1;
      }
      // One on each edge that leads from one side of the surface to the other.
      for (uint32_t corner = 0; corner < 8; ++corner) {
        for (uint32_t d = 1; d < 8; ++d) {
          if ((corner & d) != 0) continue;
          const bool crossed = (inside >> corner & 1) != (inside >> (corner | d) & 1);
          const bool has = (cell->directions >> (d - 1) & 1) != 0;
          CHECK(used[CellFaces::vertex_on(corner, d)] == static_cast<int>(crossed && has));
        }
      }
      const std::map<Edge, int> border = border_of(*cell, inside);
      for (const Face& f : faces_of(*cell, inside)) {
        for (size_t k = 0; k < 3; ++k) {
          const Edge edge{f[k], f[(k + 1) % 3]};
          const auto at_border = border.find(edge);
          const int sides = std::popcount(sides_of(edge.first) & sides_of(edge.second));
          CHECK(sides == (at_border == border.end() ? 0 : at_border->second));
        }
      }
      // What is seen of the near side of an axis from the cell beyond it, whose far side it is.
      for (uint32_t axis = 0; axis < 3; ++axis) {
        const uint32_t bit = 1U << axis;
        uint32_t beyond = 0;
        for (uint32_t c = 0; c < 8; ++c) {
          if ((c & bit) != 0) beyond |= (inside >> (c ^ bit) & 1) << c;
        }
        const std::map<Edge, int> other = border_of(*cell, beyond);
        std::vector<Edge> here, there;
        for (const auto& [edge, count] : border) {
          if ((sides_of(edge.first) & sides_of(edge.second) & bit) != 0) here.push_back(edge);
        }
        for (const auto& [edge, count] : other) {
          if ((sides_of(edge.first) & sides_of(edge.second) & bit << 3) == 0) continue;
          const auto near = [&](uint8_t v) {
            return CellFaces::vertex_on(CellFaces::corner(v) & ~bit, CellFaces::direction(v));
          };
          there.emplace_back(near(edge.second), near(edge.first));
        }
        std::sort(there.begin(), there.end());
        CHECK(here == there);
      }
    }
  }
}
