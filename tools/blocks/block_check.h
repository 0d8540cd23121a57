// The proof that the blocks are one valid surface, block by block: only what touches one is in
// memory at a time.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "engine/pellicle.h"
#include "tools/blocks/block_plan.h"

namespace plc::tools {

// Lengths in voxels.
struct BlockCheck {
  int64_t vertices = 0, faces = 0;
  int64_t components = 0, inward = 0;  // inward: those of negative volume, walls of cavities
  int64_t euler = 0, genus = 0;        // of a closed surface
  double area = 0, volume = 0;
  double edge_min = 0, edge_max = 0;
  // What is wrong: vertices whose faces are not one closed umbrella, faces of no area, pairs of
  // faces that meet, and faces that reach farther out of their cell than others look.
  int64_t open_vertices = 0, degenerate_faces = 0, self_intersections = 0, stray_faces = 0;

  bool valid() const {
    return faces > 0 && open_vertices + degenerate_faces + self_intersections + stray_faces == 0;
  }
};

// What the proof is made of. A face lies within a part of the margin of its cell, so that whatever
// it can meet or share a vertex with is in the window of its block. There, exactly: every vertex of
// the block's own faces is at one place in all cells, and its faces make one closed umbrella, each
// edge run once in either direction; no two faces meet elsewhere than in what they share. All
// blocks together: a closed, oriented manifold without self-intersections.
//
// step: of the plan, before which the tasks are done; plan.steps(): the result. told: after each
// block. Throws Failure where a file is missing or damaged, or cells disagree.
// 16 hexadecimal digits of all files of the last level, in the order of blocks: the same wherever
// and in whatever order tasks were done. Throws Failure.
std::string hash_of_blocks(const std::string& folder, const BlockPlan& plan);

BlockCheck check_blocks(const std::string& folder, const BlockPlan& plan, int step,
                        plc_context* context, const std::function<void(int64_t)>& told);

}  // namespace plc::tools
