// The faces of iso-surfaces within a cell of a lattice.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace plc {

// By which corners of the cell are inside: bit c of a byte, where bit a of c tells whether corner c
// is at the far end of axis a. Vertices lie on edges from a corner to one that is at the far end of
// more axes, bit a of the edge's direction 1 .. 7 for axis a.
struct CellFaces {
  static constexpr uint32_t kCases = 256;

  uint32_t directions = 0;                    // bit d - 1: of edges with vertices
  std::array<uint32_t, kCases + 1> first{};   // those of a case end where the next one's begin
  std::vector<std::array<uint8_t, 3>> faces;  // vertex_on() thrice, outward

  static uint8_t vertex_on(uint32_t corner, uint32_t direction) {
    return static_cast<uint8_t>(corner | direction << 3);
  }
  static uint32_t corner(uint8_t vertex) { return vertex & 7U; }
  static uint32_t direction(uint8_t vertex) { return vertex >> 3; }
};

// Marching tetrahedra on the six of Kuhn and Freudenthal around the cell's main diagonal. They are
// the same from cell to cell, so the surface is that of a continuous function, linear in each:
// closed, embedded and a manifold whatever is inside. Corners that touch along (1,1,1), (1,1,0),
// (1,0,1), (0,1,1) and the axes are connected. All seven directions.
const CellFaces& tetrahedron_faces();

// Marching cubes: vertices on the axes' directions alone, so a third as many. Corners that touch
// along the axes are connected, and no others: where those inside are across from each other on a
// side of the cell they are apart. The borders of the surface on the cell's sides are the same from
// both cells of a side; each is filled with the fan of the smallest area that has no edge in a side
// but its border. test_cell_faces.cpp shows of every case that, wherever vertices are on their
// edges, kIsoMargin from the ends at least, faces of a cell meet in what they share and in nothing
// else. So this surface, too, is closed, embedded and a manifold whatever is inside.
const CellFaces& cube_faces();

}  // namespace plc
