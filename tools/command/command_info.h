// `pellicle info`: what a file holds, an image or a mesh.
#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/volume/nifti_frame.h"

namespace plc::tools {

struct InfoOptions {
  std::string input;
  NiftiFrame nifti_frame = NiftiFrame::kAuto;
  bool json = false;
};

void add_info_options(CLI::App& command, InfoOptions& options);

// Returns the exit code: 0. Throws Failure.
int run_info(const InfoOptions& options);

}  // namespace plc::tools
