// What of the other labels' surfaces lies near one that grows.
#pragma once
#include <array>
#include <vector>

#include "tools/command/label_piece.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

class LabelNeighbours {
 public:
  // reach: how far a surface may grow, in the unit of the meshes. The boxes are those of the
  // surfaces as they are now.
  LabelNeighbours(const std::vector<LabelPiece>& pieces, double reach);

  // The faces of the others, as they are by now, that reach into the box of piece `own`.
  TriangleMesh around(size_t own) const;

 private:
  struct Box {
    std::array<double, 3> low, high;
    bool overlaps(const Box& other) const;
  };
  static void append_within(const TriangleMesh& from, const Box& box, TriangleMesh& to);

  const std::vector<LabelPiece>& pieces_;
  std::vector<Box> boxes_;
};

}  // namespace plc::tools
