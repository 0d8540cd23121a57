#include "engine/start/cell_faces.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace plc {

namespace {

using Face = std::array<uint8_t, 3>;
using Faces = std::vector<Face>;

bool has(uint32_t corners, uint32_t corner) {
  return (corners >> corner & 1) != 0;
}

// On the edge between two corners of which one is at the far end of all axes that the other is.
uint8_t vertex_between(uint32_t p, uint32_t q) {
  return CellFaces::vertex_on(p & q, p ^ q);
}

// ---- tetrahedra -----------------------------------------------------------------------------

// The corners of the six tetrahedra of a cell: along three axes in turn. All are positively
// oriented: odd orders of axes have two corners exchanged.
constexpr uint32_t kTetrahedra[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                        {0, 3, 2, 7}, {0, 5, 1, 7}, {0, 6, 4, 7}};
// Even permutations that put the corner, or the two corners, of one side first.
constexpr uint32_t kOneFirst[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 0, 1, 3}, {3, 0, 2, 1}};
constexpr uint32_t kTwoFirst[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                      {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};

// The one or two faces in a tetrahedron, away from its corners that are inside.
void cut(const uint32_t (&corner)[4], uint32_t inside, Faces& faces) {
  uint32_t mask = 0;
  for (uint32_t k = 0; k < 4; ++k) mask |= (inside >> corner[k] & 1) << k;
  if (mask == 0 || mask == 15) return;
  const auto on = [&](uint32_t j, uint32_t k) { return vertex_between(corner[j], corner[k]); };
  for (const auto& [a, b, c, d] : kOneFirst) {
    if (mask == 1U << a) faces.push_back({on(a, b), on(a, c), on(a, d)});
    if (mask == (15U ^ 1U << a)) faces.push_back({on(a, b), on(a, d), on(a, c)});
  }
  for (const auto& [a, b, c, d] : kTwoFirst) {
    if (mask != (1U << a | 1U << b)) continue;
    faces.push_back({on(a, c), on(a, d), on(b, d)});
    faces.push_back({on(a, c), on(b, d), on(b, c)});
  }
}

// ---- cubes ----------------------------------------------------------------------------------

using Loop = std::vector<uint8_t>;

// What follows a vertex on the border of the faces, outward.
class Borders {
 public:
  explicit Borders(uint32_t inside) {
    next_.fill(kNone);
    for (uint32_t axis = 0; axis < 3; ++axis) {
      const uint32_t far = 1U << axis, b = 1U << (axis + 1) % 3, c = 1U << (axis + 2) % 3;
      // Counter-clockwise, seen from outside the cell.
      add({far, far | b, far | b | c, far | c}, inside);
      add({0, c, b | c, b}, inside);
    }
  }

  // That of a vertex which was not taken yet; empty where there is none.
  Loop take() {
    Loop loop;
    for (uint8_t v = 0; v < next_.size() && loop.empty(); ++v) {
      for (uint8_t w = v; next_[w] != kNone;) {
        loop.push_back(w);
        const uint8_t next = next_[w];
        next_[w] = kNone;
        w = next;
      }
    }
    return loop;
  }

 private:
  static constexpr uint8_t kNone = 255;

  // Around the corners of a side that are inside: from where these begin to where they end.
  void add(const std::array<uint32_t, 4>& side, uint32_t inside) {
    for (size_t k = 0; k < 4; ++k) {
      const uint32_t last_outside = side[k], first_inside = side[(k + 1) % 4];
      if (has(inside, last_outside) || !has(inside, first_inside)) continue;
      size_t j = k + 1;
      while (has(inside, side[(j + 1) % 4])) ++j;
      next_[vertex_between(last_outside, first_inside)] =
          vertex_between(side[j % 4], side[(j + 1) % 4]);
    }
  }

  std::array<uint8_t, 64> next_{};
};

bool share_side(uint8_t v, uint8_t w) {
  const uint32_t along = CellFaces::direction(v) | CellFaces::direction(w);
  const uint32_t differ = CellFaces::corner(v) ^ CellFaces::corner(w);
  return (~(along | differ) & 7U) != 0;
}

// With vertices in the middle of their edges.
double area(const Face& face) {
  int at[3][3];
  for (size_t k = 0; k < 3; ++k) {
    for (uint32_t a = 0; a < 3; ++a) {
      const uint32_t corner = CellFaces::corner(face[k]) >> a & 1;
      at[k][a] = static_cast<int>(2 * corner + (CellFaces::direction(face[k]) >> a & 1));
    }
  }
  int squared = 0;
  for (size_t a = 0; a < 3; ++a) {
    const size_t b = (a + 1) % 3, c = (a + 2) % 3;
    const int cross = (at[1][b] - at[0][b]) * (at[2][c] - at[0][c]) -
                      (at[1][c] - at[0][c]) * (at[2][b] - at[0][b]);
    squared += cross * cross;
  }
  return std::sqrt(static_cast<double>(squared)) / 8;
}

// The fan from a vertex of the loop; empty where an edge of it lies in a side of the cell.
Faces fan_from(size_t first, const Loop& loop) {
  const auto at = [&](size_t k) { return loop[(first + k) % loop.size()]; };
  for (size_t k = 2; k + 1 < loop.size(); ++k) {
    if (share_side(at(0), at(k))) return {};
  }
  Faces faces;
  for (size_t k = 1; k + 1 < loop.size(); ++k) faces.push_back({at(0), at(k), at(k + 1)});
  return faces;
}

void fill(const Loop& loop, Faces& faces) {
  constexpr double kRounding = 1e-9;
  Faces best;
  double least = std::numeric_limits<double>::max();
  for (size_t first = 0; first < loop.size(); ++first) {
    const Faces fan = fan_from(first, loop);
    double sum = 0;
    for (const Face& face : fan) sum += area(face);
    if (fan.empty() || sum > least - kRounding) continue;
    best = fan;
    least = sum;
  }
  faces.insert(faces.end(), best.begin(), best.end());
}

// add(inside, faces) adds those of a case.
template <typename Add>
CellFaces make(uint32_t directions, const Add& add) {
  CellFaces made;
  made.directions = directions;
  for (uint32_t inside = 0; inside < CellFaces::kCases; ++inside) {
    add(inside, made.faces);
    made.first[inside + 1] = static_cast<uint32_t>(made.faces.size());
  }
  return made;
}

}  // namespace

const CellFaces& tetrahedron_faces() {
  static const CellFaces faces = make(0b1111111, [](uint32_t inside, Faces& of_case) {
    for (const auto& tetrahedron : kTetrahedra) cut(tetrahedron, inside, of_case);
  });
  return faces;
}

const CellFaces& cube_faces() {
  // 1, 2 and 4.
  static const CellFaces faces = make(0b0001011, [](uint32_t inside, Faces& of_case) {
    Borders borders(inside);
    for (Loop loop = borders.take(); !loop.empty(); loop = borders.take()) fill(loop, of_case);
  });
  return faces;
}

}  // namespace plc
