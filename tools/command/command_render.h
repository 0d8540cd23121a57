// `pellicle render`: a shaded picture of a mesh.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/render/render.h"

namespace plc::tools {

struct RenderOptions {
  std::string mesh;
  std::string output;
  View view;
  int size = 1200;  // pixels
  bool montage = false;
};

void add_render_options(CLI::App& command, RenderOptions& options);

// Returns the exit code. Throws Failure.
int run_render(const RenderOptions& options);

}  // namespace plc::tools
