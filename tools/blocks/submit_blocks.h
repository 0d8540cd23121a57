// What is left of an image by blocks as job arrays of Slurm: one for each step.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/blocks/block_plan.h"

namespace plc::tools {

struct BlockSubmit {
  std::string folder;
  int cores = 1;                      // of a task
  int64_t memory = int64_t{4} << 30;  // of a task, bytes
  double minutes = 60;                // that a block may take
  bool dry_run = false;
  std::vector<std::string> slurm;  // further options of sbatch
};

// Writes one script, DIR/submitted/1.sh, and submits it for each step that has blocks left, each
// after the one before. Everything that is run is printed; with dry_run it is only printed. Where
// one is refused those before it are taken back. Throws Failure.
void submit_blocks(const BlockSubmit& options, const BlockPlan& plan);

// The shares of a step, I of N from 1 on, that have blocks left: "1-3,7". `blocks`: of the colour,
// `left` of them, both ascending.
std::string shares_left(const std::vector<int64_t>& blocks, const std::vector<int64_t>& left,
                        size_t shares);

}  // namespace plc::tools
