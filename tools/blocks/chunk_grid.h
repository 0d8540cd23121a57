// How the surface of a plan is divided for neuroglancer: an octree of chunks, and the boxes of
// cells that are in memory at a time.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "tools/blocks/block_plan.h"
#include "tools/volume/volume_frame.h"

namespace plc::tools {

using Triangle = std::array<Place, 3>;  // here in voxel indices

// Chunks of level of detail l are cubes of chunk(l) = chunk(0) * 2^l voxels, from origin() on each
// axis. The side of a plan's blocks is one of them, so that a box of that side holds whole chunks
// of the fine levels of detail. All planes between chunks are numbers that floats hold exactly.
class ChunkGrid {
 public:
  // Voxels around the image that belong to the octree, too: the engine pads by as many.
  static constexpr int64_t kRim = 6;
  // Chunks of level of detail 0 are at most so large: some ten thousand faces each.
  static constexpr double kFinestChunk = 64;
  // Clusters of vertices on each axis of a chunk, on every level of detail but 0: with chunks of 64
  // voxels those of level 1 are 4 voxels wide, and a level has about a quarter of the faces of the
  // one below.
  static constexpr int64_t kClusters = 32;

  // lods 0: until one chunk holds everything. Throws Failure where there are more than that.
  ChunkGrid(const BlockPlan& plan, int lods);

  int lods() const { return lods_; }
  static double origin() { return -static_cast<double>(kRim); }
  double chunk(int lod) const;
  // How many there are on each axis.
  Int3 chunks(int lod) const;
  // The width of clusters; lod > 0.
  double cluster(int lod) const { return chunk(lod) / static_cast<double>(kClusters); }
  // The last level of detail that is made of the surface, box by box; those above it are made of
  // this one, which is held whole. Of such a small surface as one box is, 0 where lods() is 1.
  int near_lods() const { return near_; }

  // Of side box_side(), in the order of the Z-curve, each by its number on each axis.
  const std::vector<Int3>& boxes() const { return boxes_; }
  double box_side() const { return chunk(box_lod_); }
  // Chunks of a box on each axis; lod at most near_lods().
  int64_t box_chunks(int lod) const { return int64_t{1} << (box_lod_ - lod); }
  // The cells that hold every face that has to be known for a box: those that meet it, and those
  // that meet a cluster of a face of it.
  std::vector<Int3> cells_around(const Int3& box) const;

  // Whether a cell's faces are where they are expected: none longer than reach(), or farther from
  // the cell than that, or outside of the octree.
  bool holds(const Int3& cell, const BlockCell& faces) const;
  double reach() const { return reach_; }

 private:
  struct Span {
    double low, high;
  };

  int lods_ = 1, near_ = 0, box_lod_ = 1;
  double finest_ = 0, reach_ = 0, halo_ = 0;
  std::array<std::vector<Span>, 3> cells_;  // of the plan, on each axis
  std::vector<Int3> boxes_;
  Place end_{};
};

// In the order of the Z-curve: x is least significant. Numbers are at least 0.
bool z_before(const Int3& l, const Int3& r);
struct ZOrder {
  bool operator()(const Int3& l, const Int3& r) const { return z_before(l, r); }
};

}  // namespace plc::tools
