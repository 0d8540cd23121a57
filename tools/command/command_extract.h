// `pellicle extract`: a surface out of a volume.
#pragma once
#include "tools/command/extract_options.h"
#include "tools/command/interrupt.h"

namespace plc::tools {

// Returns the exit code. Throws Failure.
int run_extract(const ExtractOptions& options, InterruptGuard& interrupt);

}  // namespace plc::tools
