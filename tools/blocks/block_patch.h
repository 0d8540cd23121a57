// The surface within a window as a patch that evolves, and what has become of it as cells again.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/blocks/block_file.h"
#include "tools/blocks/block_grid.h"

namespace plc::tools {

// What several cells hold together: each vertex once.
struct BlockMesh {
  std::vector<uint64_t> ids;  // ascending
  std::vector<double> xyz;
  std::vector<uint32_t> abc;

  size_t vertex_count() const { return ids.size(); }
  size_t face_count() const { return abc.size() / 3; }
};

// Throws Failure where cells disagree about the place of a vertex; `what` names them.
BlockMesh joined(const std::map<Int3, BlockCell>& cells, const std::string& what);

// Of each vertex whether all faces around it are there and make one umbrella: kWhole; none or
// several fans with gaps: kBorder. kBroken: what no part of a closed, oriented manifold has.
enum class Star : uint8_t { kWhole, kBorder, kBroken };
struct Stars {
  std::vector<Star> star;
  std::vector<uint32_t> fans;  // 1 of a whole star
};
Stars stars_of(const BlockMesh& mesh);

struct Patch {
  BlockMesh mesh;                              // as plc_extras takes it: no border touches itself
  std::vector<uint8_t> held;                   // by vertex, as plc_extras takes it
  std::vector<std::array<uint64_t, 3>> aside;  // faces that are left out of it, by ids
  std::map<uint64_t, std::array<double, 3>> aside_places;  // of their corners
  size_t free = 0;                                         // vertices that are not held
};

// Held is what lies outside of the room, and what is nearer to a border than kHeldRings edges.
// coarse: ids below it are of the level above, whose faces are to be refined.
inline constexpr int kHeldRings = 3;
Patch patch_of(BlockMesh mesh, const std::array<double, 3>& room_low,
               const std::array<double, 3>& room_high, uint64_t coarse, const std::string& what);

// The faces, each in the cell of the window nearest to its middle, in an order that only depends on
// the faces themselves.
std::map<Int3, BlockCell> divided(const BlockMesh& mesh, const BlockGrid& grid,
                                  const BlockGrid::Window& window);

}  // namespace plc::tools
