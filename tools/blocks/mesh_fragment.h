// The meshes of chunks as neuroglancer reads them: corners on a grid of integers, packed by Draco.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "tools/blocks/chunk_grid.h"
#include "tools/blocks/face_cutter.h"

namespace plc::tools {

// Positions within a chunk are 0 .. 65535 on each axis. A corner on a plane between chunks is 65535
// in the lower one and 0 in the upper one, and the same on the other axes: nothing gapes. On the
// plane that halves a chunk it is 32768, as neuroglancer asks for: it draws eighths of a chunk.
inline constexpr int kPositionBits = 16;

struct MeshFragment {
  using Corner = uint64_t;                   // x, y and z, kPositionBits of each, x lowest
  std::vector<std::array<Corner, 3>> faces;  // outward; no two corners are the same
  uint8_t eighths = 0;                       // which of them have faces; bit: x + 2 y + 4 z
};

// The chunks of a level of detail with numbers from `first` to below `end`.
class MeshFragments {
 public:
  MeshFragments(const ChunkGrid& grid, int lod, const Int3& first, const Int3& end);

  // What lies outside of these chunks is left out, and so is what has no two corners apart.
  void add(const Triangle& face);
  const std::map<Int3, MeshFragment, ZOrder>& all() const { return fragments_; }

 private:
  int lod_;
  double side_;  // of a chunk
  Int3 first_, end_;
  Place low_{}, high_{};  // of all chunks
  FaceCutter cutter_;     // of chunks; above level of detail 0 of their eighths
  std::map<Int3, MeshFragment, ZOrder> fragments_;
};

// Whether this was built with libdraco.
bool has_draco();
// The same faces make the same bytes. Throws Failure, also without libdraco.
std::string packed_fragment(const MeshFragment& fragment);

}  // namespace plc::tools
