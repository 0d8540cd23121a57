// `pellicle view`: a page that shows an image and surfaces.
#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tools/view/grey_image.h"
#include "tools/volume/nifti_frame.h"

namespace plc::tools {

struct ViewOptions {
  std::string image;
  std::vector<std::string> surfaces;
  std::string output = "view.html";
  plc_space space = PLC_SPACE_LPS;
  NiftiFrame nifti_frame = NiftiFrame::kAuto;
  std::optional<GreyWindow> window;
  int64_t max_voxels = 1 << 24;
};

void add_view_options(CLI::App& command, ViewOptions& options);

// Returns the exit code. Throws Failure.
int run_view(const ViewOptions& options);

}  // namespace plc::tools
