// One task: a block on a level. It reads what its window holds, lets it evolve against what is
// around, and writes its file.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "engine/pellicle.h"
#include "tools/blocks/block_plan.h"
#include "tools/blocks/block_record.h"

namespace plc::tools {

// The tasks of one process, one after the other. The volume is the image of the plan, and is read
// where a surface is; of bricks, with the range that the plan tells.
class BlockTasks {
 public:
  // context and volume must outlive this.
  BlockTasks(std::string folder, BlockPlan plan, plc_context* context, const plc_volume* volume);

  const BlockPlan& plan() const { return plan_; }
  const std::string& folder() const { return folder_; }
  bool done(int step, int64_t block) const;
  // All tasks of earlier steps whose windows touch this one must be done. Where the task is done
  // already it is run again, and writes the same file. cancelled: asked now and then; where it says
  // so nothing is written and `false` returned. Throws Failure.
  bool run(int step, int64_t block, const std::function<bool()>& cancelled, TaskRecord& record);

 private:
  struct Deleter {
    void operator()(plc_pyramid* pyramid) const { plc_pyramid_destroy(pyramid); }
    void operator()(plc_run* run) const { plc_run_destroy(run); }
    void operator()(plc_surface* surface) const { plc_surface_destroy(surface); }
  };
  using Pyramid = std::unique_ptr<plc_pyramid, Deleter>;
  using Run = std::unique_ptr<plc_run, Deleter>;
  using Surface = std::unique_ptr<plc_surface, Deleter>;

  void demand(plc_status status) const;
  int64_t bricks_read() const;
  const plc_pyramid* pyramid_of(int level);
  Patch patch_in(const std::map<Int3, BlockCell>& cells, const BlockGrid::Window& window, int step,
                 const std::string& what) const;
  void room_of(const BlockGrid::Window& window, double* low, double* high) const;
  Surface evolve(const Patch& patch, int step, int64_t block,
                 const std::function<bool()>& cancelled, TaskRecord& record);
  BlockMesh after(const Patch& patch, const plc_surface* surface, int step, int64_t block) const;

  std::string folder_;
  BlockPlan plan_;
  plc_context* context_;
  const plc_volume* volume_;
  Pyramid pyramid_;  // of the level at hand
  int level_ = -1;
};

// The cells, each as the last task before `step` has left it. Throws Failure where one is not done.
std::map<Int3, BlockCell> cells_before(const std::string& folder, const BlockPlan& plan, int step,
                                       const std::vector<Int3>& cells);

// The coarse levels' surface as the blocks' files of the start. xyz: voxel indices.
void write_start(const std::string& folder, const BlockPlan& plan, const std::vector<double>& xyz,
                 const std::vector<uint32_t>& abc);

}  // namespace plc::tools
