// `pellicle blocks plan`: the coarse levels, whole, and the tasks of the rest.
#pragma once
#include <CLI/CLI.hpp>

#include "tools/command/command_blocks.h"
#include "tools/command/interrupt.h"

namespace plc::tools {

// Declares its options; parsing fills `options`.
void add_block_plan(CLI::App& app, BlockOptions& options);

// The exit code. Throws Failure.
int run_block_plan(BlockOptions& options, InterruptGuard& interrupt);

}  // namespace plc::tools
