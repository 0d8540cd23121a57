// Reading of volumes: ITK's formats and InVesalius projects.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "engine/pellicle.h"

namespace plc::tools {

// What a command reports to its user: one line, without a newline.
struct Failure {
  std::string message;
};

// A volume in memory; image.voxels points into bytes.
struct LoadedVolume {
  plc_image image{};
  std::vector<std::byte> bytes;
};

// NIfTI, NRRD, MetaImage, a DICOM directory, a TIFF stack, or an InVesalius .inv3. Throws Failure.
LoadedVolume read_volume(const std::string& path);

// .nrrd, .mha or .mhd by suffix; atomically. Throws Failure.
void write_volume(const std::string& path, const plc_image& image);

}  // namespace plc::tools
