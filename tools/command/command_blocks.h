// `pellicle blocks`: one surface of one large image, in tasks.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "tools/blocks/precomputed.h"
#include "tools/blocks/submit_blocks.h"
#include "tools/command/extract_options.h"
#include "tools/command/interrupt.h"

namespace plc::tools {

struct BlockOptions {
  ExtractOptions extract;  // of plan
  std::string folder;
  int64_t side = 512;
  int from_level = 1;
  std::optional<int> step;  // of run; none: all
  int part = 1, parts = 1;
  int threads = 0;
  std::optional<int64_t> memory;  // bytes
  bool quiet = false, json = false;
  bool serve = false;  // tasks that stdin names
  BlockSubmit submit;
  std::string mesh;  // that `mesh` writes
  plc_space space = PLC_SPACE_LPS;
  PrecomputedOptions precomputed;
};

// Declares plan, run, status, submit, check, mesh and precomputed under `command`.
void add_block_options(CLI::App& command, BlockOptions& options);

// Returns the exit code: 1 where tasks are left, or the surface is not valid. Throws Failure.
int run_block_command(const CLI::App& command, BlockOptions& options, InterruptGuard& interrupt);

}  // namespace plc::tools
