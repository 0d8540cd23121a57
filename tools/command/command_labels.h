// `pellicle extract --labels`: a surface around every label of a label image.
#pragma once
#include <CLI/CLI.hpp>

#include "tools/command/extract_options.h"
#include "tools/command/interrupt.h"

namespace plc::tools {

// Declares --labels on `command`, after add_extract_options(): it takes the place of INPUT and
// excludes whatever tells what the object of an image is.
void add_label_options(CLI::App& command, ExtractOptions& options);

// One mesh per label, OUTPUT-LABEL.SUFFIX, none of which meets another or lies inside it: a label
// that another one encloses lies in a cavity of that one. Labels too small to hold a surface are
// told on stderr and left out. Nothing is written before all of them are there, and valid together.
// Returns the exit code. Throws Failure, also where two of them overlap whatever was tried.
int run_labels(const ExtractOptions& options, InterruptGuard& interrupt);

}  // namespace plc::tools
