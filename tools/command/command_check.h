// `pellicle check`: what a mesh is, and whether it is a valid surface.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "engine/pellicle.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

struct CheckOptions {
  std::string mesh;
  bool json = false;
};

void add_check_options(CLI::App& command, CheckOptions& options);

// Throws Failure where an index or a coordinate is out of range.
plc_check check_of(plc_context* context, const TriangleMesh& mesh);

// Returns the exit code: 1 when the mesh is not valid. Throws Failure.
int run_check(const CheckOptions& options);

}  // namespace plc::tools
