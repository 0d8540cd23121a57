// Reading of volumes: NIfTI, OME-Zarr, ITK's formats and InVesalius projects.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tools/file/shared_bytes.h"
#include "tools/volume/nifti_frame.h"

namespace plc::tools {

// A volume in memory; image.voxels points into bytes.
struct LoadedVolume {
  plc_image image{};
  SharedBytes bytes;
  std::vector<std::string> warnings;  // what a user should know of it: lines without their ends
};

// NIfTI, NRRD, MetaImage, a folder of OME-Zarr, a DICOM directory, a TIFF stack, or an InVesalius
// .inv3. frame: of NIfTI alone. Throws Failure.
LoadedVolume read_volume(const std::string& path, NiftiFrame frame = NiftiFrame::kAuto);

// The same in a child process, where libraries that abort or do not end harm nobody: what the
// commands use. Before the process starts threads; see apart.h.
LoadedVolume read_volume_apart(const std::string& path, NiftiFrame frame = NiftiFrame::kAuto);

// Warnings to stderr, a line each.
void print_warnings(const std::vector<std::string>& warnings);

// .nrrd, .mha, .mhd or .zarr by suffix; atomically. Throws Failure.
void write_volume(const std::string& path, const plc_image& image);

}  // namespace plc::tools
