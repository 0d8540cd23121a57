// Annular transformation: a narrow tube is cut along a cycle of three edges (figure 5);
// going past the paper, or of four.
#pragma once
#include <array>

#include "engine/transform/edge.h"

namespace plc {

// Edges from corner to corner, closed, not a face; of four no two opposite ones are neighbours. The
// left side is the one that lies to the left when it is walked.
struct Cycle {
  static constexpr uint32_t kMost = 4;
  std::array<uint32_t, kMost> corner;
  uint32_t size = 3;

  uint32_t next(uint32_t i) const { return i + 1 == size ? 0 : i + 1; }
  uint32_t previous(uint32_t i) const { return i == 0 ? size - 1 : i - 1; }
  // Holes of four corners are closed by two faces with an edge between the first and the third.
  bool on_diagonal(uint32_t i) const { return size == 4 && i % 2 == 0; }
};

// The neighbours of v strictly between two others, counter-clockwise.
Neighbors arc_between(const Mesh& mesh, uint32_t v, uint32_t from, uint32_t to);

// One side of the cut at one corner: the neighbours strictly inside it, and where the copy goes.
struct CutCopy {
  Neighbors arc;
  Vec3 place;
};
// Of the corners, to the left and to the right. Each copy has retreated from the cut towards the
// mean of its own arc.
using CutCopies = std::array<std::array<CutCopy, Cycle::kMost>, 2>;
CutCopies annular_copies(const Mesh& mesh, const Cycle& cycle, float retreat);

// Cuts the surface and closes both holes: the corners keep the left arcs, the new vertices
// (returned in their order) have the right ones. Changes the rings of the corners and of their
// neighbours.
std::array<uint32_t, Cycle::kMost> cut_cycle(Mesh& mesh, const Cycle& cycle,
                                             const CutCopies& copies, uint32_t cut_id,
                                             uint32_t iteration);

}  // namespace plc
