// Faces cut at the planes of a grid of cubes.
#pragma once
#include <vector>

#include "tools/blocks/chunk_grid.h"

namespace plc::tools {

// Faces that share an edge are cut at the same points of it, to the bit, whichever of them is cut
// where: a point follows from the ends of the edge and the plane, in an order that is always the
// same. The pieces of closed surfaces are closed together.
class FaceCutter {
 public:
  struct Piece {
    Triangle corners;
    Int3 cube;  // holds all corners, borders included
  };

  FaceCutter(double origin, double side) : origin_(origin), side_(side) {}

  // Until the next call. What lies in a plane belongs to the cube above it.
  const std::vector<Piece>& cut(const Triangle& face);
  double plane(int64_t number) const { return origin_ + static_cast<double>(number) * side_; }

 private:
  int64_t slab_of(double x) const;
  void cut_axis(const Piece& piece, size_t axis);

  double origin_, side_;
  std::vector<Piece> pieces_, next_;
};

}  // namespace plc::tools
