// `pellicle mesh`: meshes from one format or space to another, parts of them, several in one.
#pragma once
#include <CLI/CLI.hpp>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tools/command/keep_rule.h"
#include "tools/volume/nifti_frame.h"

namespace plc::tools {

struct MeshOptions {
  std::vector<std::string> inputs;
  std::string output;
  std::string image;               // "": none
  std::optional<plc_space> from;   // of files that name no space; without it LPS
  std::optional<plc_space> space;  // without it that of the first input
  std::optional<std::array<double, 6>> crop;
  KeepRule keep;
  NiftiFrame nifti_frame = NiftiFrame::kAuto;
  bool merge = false;
};

void add_mesh_options(CLI::App& command, MeshOptions& options);

// Returns the exit code: 0. Never makes a valid mesh invalid: Failure, and nothing is written,
// where it would.
int run_mesh(const MeshOptions& options);

}  // namespace plc::tools
