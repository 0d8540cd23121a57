// That a triangle lies within a distance of a mesh: proved piece by piece, not sampled.
//
// The distance to one face, which is convex, is a convex function: over a triangle it is largest at
// a corner. A piece all of whose corners are near one and the same face is near it as a whole, and
// so is one whose middle is near the mesh by more than the piece's own radius. Any other is halved
// across its longest side (M. Tang, M. Lee, Y. J. Kim, "Interactive Hausdorff Distance Computation
// for General Polygonal Models", SIGGRAPH 2009, do it in four). The middle of a side is rounded, by
// about 1e-16 of the coordinates.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/base/double3.h"
#include "engine/measure/point_triangle.h"
#include "pyramid/memory.h"

namespace plc {

inline constexpr uint32_t kNoFace = 0xffffffffU;

using Corners3 = std::array<Double3, 3>;

inline Double3 point_of(const double* xyz, uint32_t v) {
  const double* p = xyz + 3 * static_cast<size_t>(v);
  return {p[0], p[1], p[2]};
}

inline double squared_distance_to_triangle(const Double3& p, const Corners3& t) {
  return squared_distance_to_triangle(&p.x, &t[0].x, &t[1].x, &t[2].x);
}

// The largest squared distance from a place of the triangle to the face.
inline double farthest_from(const Corners3& triangle, const Corners3& face) {
  double farthest = 0;
  for (const Double3& p : triangle) {
    farthest = std::fmax(farthest, squared_distance_to_triangle(p, face));
  }
  return farthest;
}

// What is asked for, and what has been found; of squared distances.
struct CoverBound {
  double limit;
  // Whether a place beyond the limit raises it, so that a bound is found whatever it is; else it
  // ends the proof.
  bool raise = false;
  double at_least = 0, at_most = 0;  // of the largest distance
};

// The pieces of a proof; kept from one to the next for their memory.
class Cover {
 public:
  // False: not within the limit, or not proved; never where the limit is raised. Target:
  //   Corners3 corners(face)              of the mesh
  //   double nearest(p, uint32_t& face)   the squared distance from p, and the face that has it;
  //                                       face is a guess before
  //   void use(face)                      a part of the triangle is near this face
  template <typename Target>
  bool run(Target& target, const Corners3& triangle, uint32_t start, CoverBound& bound);

 private:
  // A proof that needs more is given up: where the distance is nearly the limit all over a piece
  // thousands would say no more.
  static constexpr size_t kMostProofPieces = 256;
  // How far above what is found the limit is raised, and which part of it pieces may measure that
  // are not cut: together they make the bound at most 2 % larger than it could be.
  static constexpr double kRaise = 1.004, kFinest = 1.0 / 64;

  struct Piece {
    Corners3 corner;
    uint32_t face;  // probably near it
  };

  void halve(const Piece& piece);

  Vector<Piece> stack_;
};

// ---- implementation -------------------------------------------------------------------------

inline void Cover::halve(const Piece& piece) {
  size_t longest = 0;
  double square = -1;
  for (size_t k = 0; k < 3; ++k) {
    const Double3 side = piece.corner[(k + 1) % 3] - piece.corner[k];
    if (dot(side, side) > square) square = dot(side, side), longest = k;
  }
  const size_t next = (longest + 1) % 3;
  const Double3 middle = (piece.corner[longest] + piece.corner[next]) * 0.5;
  for (const size_t k : {longest, next}) {
    stack_.push_back(piece);
    stack_.back().corner[k] = middle;
  }
}

template <typename Target>
bool Cover::run(Target& target, const Corners3& triangle, uint32_t start, CoverBound& bound) {
  stack_.clear();
  stack_.push_back({triangle, start});
  for (size_t pieces = 0; !stack_.empty(); ++pieces) {
    if (pieces == kMostProofPieces && !bound.raise) return false;
    Piece piece = stack_.back();
    stack_.pop_back();
    double farthest = farthest_from(piece.corner, target.corners(piece.face));
    if (farthest > bound.limit) {
      const Double3 centre = (piece.corner[0] + piece.corner[1] + piece.corner[2]) * (1.0 / 3);
      const double squared = target.nearest(centre, piece.face);
      bound.at_least = std::fmax(bound.at_least, squared);
      if (squared > bound.limit) {
        if (!bound.raise) return false;
        bound.limit = squared * kRaise * kRaise;
      }
      double radius = 0;
      for (const Double3& p : piece.corner) radius = std::fmax(radius, dot(p - centre, p - centre));
      const double reach = std::sqrt(squared) + std::sqrt(radius);
      farthest = std::fmin(reach * reach, farthest_from(piece.corner, target.corners(piece.face)));
      const bool fine = bound.raise && radius <= kFinest * kFinest * bound.limit;
      if (farthest > bound.limit && !fine) {
        halve(piece);
        continue;
      }
    }
    bound.at_most = std::fmax(bound.at_most, farthest);
    target.use(piece.face);
  }
  return true;
}

}  // namespace plc
