// Annular transformation: a narrow tube is cut along a cycle of three edges (figure 5).
#pragma once
#include <array>

#include "engine/transform/edge.h"

namespace plc {

// The edges u-v, v-o, o-u, not a face. The left side is the one that lies to the left when the
// cycle is walked u, v, o.
struct Cycle {
  std::array<uint32_t, 3> corner;  // u, v, o
};

// One side of the cut at one corner: the neighbours strictly inside it, and where the copy goes.
struct CutCopy {
  Neighbors arc;
  Vec3 place;
};
// [0..2] the left copies of u, v, o, [3..5] the right ones. Each copy has retreated from the cut
// towards the mean of its own arc.
std::array<CutCopy, 6> annular_copies(const Mesh& mesh, const Cycle& cycle, float retreat);

// Cuts the surface and closes both holes with a triangle: u, v, o keep the left arcs, the three new
// vertices (returned in the order of the corners) have the right ones. Changes the rings of the
// corners and of their neighbours.
std::array<uint32_t, 3> cut_cycle(Mesh& mesh, const Cycle& cycle,
                                  const std::array<CutCopy, 6>& copies, uint32_t cut_id,
                                  uint32_t iteration);

}  // namespace plc
