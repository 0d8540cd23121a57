// `pellicle simplify`: a mesh of fewer vertices within a distance.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/command/progress_line.h"

namespace plc::tools {

struct SimplifyOptions {
  std::string mesh, output;
  double tolerance = 0;
  bool one_sided = false;
  bool quiet = false;
};

void add_simplify_options(CLI::App& command, SimplifyOptions& options);

// Returns the exit code: 0. Throws Failure where the mesh is not valid, and nothing is written.
int run_simplify(const SimplifyOptions& options);

}  // namespace plc::tools
