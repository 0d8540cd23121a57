// What a run by blocks is: DIR/plan.json, and where its files are.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tools/blocks/block_grid.h"
#include "tools/blocks/block_patch.h"

namespace plc::tools {

struct BlockPlan {
  std::string version;        // Pellicle's, that planned it
  std::string input;          // an absolute path
  std::string hash;           // of the coarse surface and all that follows from it
  plc_parameters parameters;  // with everything that was derived; those of all levels
  plc_image image;            // without voxels
  double low = 0, high = 0;   // range of the voxels
  BlockGrid grid;
  int from_level = 0;  // the coarsest level that is done by blocks
  int64_t start_vertices = 0, start_faces = 0;
  // Blocks whose middle lies inside the coarse levels' surface, ascending.
  std::vector<int64_t> inside;

  int steps() const { return BlockGrid::kColours * (from_level + 1); }
  int level_of(int step) const { return from_level - step / BlockGrid::kColours; }
  // How far vertices stay within what a window holds, voxels: what is held there is as wide as
  // forces and guards look, on the level above from_level.
  double band() const { return band_of(parameters, image, from_level); }
  static double band_of(const plc_parameters& parameters, const plc_image& image, int from_level);
};

// Ids of vertices have room for so many (block_task.cpp), and for the steps of so many levels.
inline constexpr int64_t kMostBlocks = int64_t{1} << 24;
inline constexpr int kMostBlockLevels = 30;
bool too_many_blocks(const BlockGrid& grid);

// Of blocks with this band; they have sides of at least four of them.
int64_t margin_of(double band);

// DIR/plan.json, DIR/start/1-0-2.blk, DIR/level1/1-0-2.blk.
std::string block_path(const std::string& folder, const BlockPlan& plan, int step,
                       const Int3& block);

// Throws Failure.
void write_plan(const std::string& folder, const BlockPlan& plan);
// Also where another version of Pellicle has planned it.
BlockPlan read_plan(const std::string& folder);

// What the level that a task is on is made with: of plan.parameters.
plc_parameters task_parameters(const BlockPlan& plan, int level);

}  // namespace plc::tools
