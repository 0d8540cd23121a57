#include "tools/blocks/face_cutter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace plc::tools {

namespace {

// Where an edge meets the plane; its ends are on both sides.
Place crossing(Place from, Place to, size_t axis, double plane) {
  if (to < from) std::swap(from, to);
  const double t = (plane - from[axis]) / (to[axis] - from[axis]);
  Place point{};
  for (size_t a = 0; a < 3; ++a) {
    // Rounding must not take it out of the cubes that its edge is in.
    const auto [low, high] = std::minmax(from[a], to[a]);
    point[a] = std::clamp(from[a] + t * (to[a] - from[a]), low, high);
  }
  point[axis] = plane;
  return point;
}

// Three or four corners in one plane, in order.
struct Part {
  std::array<Place, 4> corners{};
  size_t count = 0;

  void add(const Place& place) { corners[count++] = place; }

  template <typename Visit>
  void visit(const Visit& visit_triangle) const {
    if (count == 3) visit_triangle(Triangle{corners[0], corners[1], corners[2]});
    if (count < 4) return;
    const auto squared = [&](size_t i, size_t j) {
      double sum = 0;
      for (size_t a = 0; a < 3; ++a) {
        sum += (corners[i][a] - corners[j][a]) * (corners[i][a] - corners[j][a]);
      }
      return sum;
    };
    const size_t first = squared(0, 2) <= squared(1, 3) ? 0 : 1;  // of the shorter diagonal
    const auto at = [&](size_t k) { return corners[(first + k) % 4]; };
    visit_triangle(Triangle{at(0), at(1), at(2)});
    visit_triangle(Triangle{at(0), at(2), at(3)});
  }
};

// A plane that has corners on both sides makes three triangles at most. Triangles are cut, not
// polygons: rounding cannot make them meet a plane more than twice.
void halve(const Triangle& face, size_t axis, double plane, Part& below, Part& above) {
  for (size_t k = 0; k < 3; ++k) {
    const Place &from = face[k], &to = face[(k + 1) % 3];
    if (from[axis] <= plane) below.add(from);
    if (from[axis] >= plane) above.add(from);
    if ((from[axis] < plane && to[axis] > plane) || (from[axis] > plane && to[axis] < plane)) {
      const Place point = crossing(from, to, axis, plane);
      below.add(point);
      above.add(point);
    }
  }
}

}  // namespace

int64_t FaceCutter::slab_of(double x) const {
  auto slab = static_cast<int64_t>(std::floor((x - origin_) / side_));
  while (x < plane(slab)) --slab;
  while (x >= plane(slab + 1)) ++slab;
  return slab;
}

// From low to high: an edge is cut at the same planes in the same order in all of its faces.
void FaceCutter::cut_axis(const Piece& piece, size_t axis) {
  const Triangle& face = piece.corners;
  const auto [low, high] = std::minmax({face[0][axis], face[1][axis], face[2][axis]});
  Piece own = piece;
  own.cube[axis] = slab_of(low);
  const double above_it = plane(own.cube[axis] + 1);
  if (high <= above_it) {
    next_.push_back(own);
    return;
  }
  Part below, above;
  halve(face, axis, above_it, below, above);
  below.visit([&](const Triangle& corners) {
    own.corners = corners;
    next_.push_back(own);
  });
  above.visit([&](const Triangle& corners) { cut_axis({corners, piece.cube}, axis); });
}

const std::vector<FaceCutter::Piece>& FaceCutter::cut(const Triangle& face) {
  pieces_.assign(1, {face, {}});
  for (size_t axis = 0; axis < 3; ++axis) {
    next_.clear();
    for (const Piece& piece : pieces_) cut_axis(piece, axis);
    pieces_.swap(next_);
  }
  return pieces_;
}

}  // namespace plc::tools
