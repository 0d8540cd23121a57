// The surface of a plan as neuroglancer shows it: precomputed, multi-resolution meshes.
// The format: github.com/google/neuroglancer, src/datasource/precomputed/meshes.md.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/blocks/block_plan.h"

namespace plc::tools {

struct PrecomputedOptions {
  std::string output;                                     // a folder; made where it is not there
  int lods = 0;                                           // 0: until one chunk holds everything
  uint64_t segment = 1;                                   // not 0
  std::function<void(size_t done, size_t all)> progress;  // of boxes; may be empty
};

struct PrecomputedRecord {
  struct Lod {
    double chunk = 0;    // voxels on each axis
    double cluster = 0;  // of vertices that became one; 0: none did
    int64_t fragments = 0, faces = 0, bytes = 0;
  };
  std::vector<Lod> lods;
};

// Three files of the output: SEGMENT, SEGMENT.index and info, which other segments of the same
// image share. Each is there whole or not at all; the same plan makes the same bytes. Level of
// detail 0 is the surface itself, cut at the planes between chunks; above it are clusters of
// vertices (vertex_clusters.h).
//
// In memory are the cells of one box (chunk_grid.h) and the chunks in it; and, where there are
// levels of detail of larger chunks than a box, the faces of the level below them: with blocks of
// 512 voxels of side, about one in a hundred of the surface's. Throws Failure.
PrecomputedRecord write_precomputed(const std::string& folder, const BlockPlan& plan,
                                    const PrecomputedOptions& options);

}  // namespace plc::tools
