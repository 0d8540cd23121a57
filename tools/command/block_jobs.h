// What schedulers need of `pellicle blocks`: status, submit, and a process that does tasks as it is
// told.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/blocks/block_task.h"
#include "tools/command/command_blocks.h"
#include "tools/command/interrupt.h"

namespace plc::tools {

// Declare them; parsing fills `folder` and `options`.
void add_block_folder(CLI::App& app, std::string& folder);
void add_block_status(CLI::App& app, BlockOptions& options);
void add_block_submit(CLI::App& app, BlockOptions& options);

// The exit code: 1 where tasks are left. Throws Failure.
int run_block_status(const BlockOptions& options);
int run_block_submit(const BlockOptions& options);

// Does each task that a line of stdin names, "STEP BLOCK", and answers it by a line of JSON on
// stdout: its record, or {"error": TEXT}. Ends when stdin does, within a task, too: whoever has
// asked is gone. Throws Failure for lines that name no task.
int serve_tasks(BlockTasks& tasks, InterruptGuard& interrupt);

}  // namespace plc::tools
