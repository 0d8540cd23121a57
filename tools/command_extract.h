// `pellicle extract`: a surface out of a volume.
#pragma once
#include "tools/extract_options.h"
#include "tools/interrupt.h"

namespace plc::tools {

// Returns the exit code. Throws Failure.
int run_extract(const ExtractOptions& options, InterruptGuard& interrupt);

}  // namespace plc::tools
