// What `pellicle extract` is told on the command line.
#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tools/command/iso_choice.h"
#include "tools/command/keep_rule.h"
#include "tools/command/option_values.h"
#include "tools/command/progress_line.h"
#include "tools/volume/nifti_frame.h"
#include "tools/volume/volume_box.h"

namespace plc::tools {

// One of several structures of an image.
struct Structure {
  std::string name;
  plc_parameters parameters;
  IsoChoice iso;  // "": none
};

struct ExtractOptions {
  std::string input;                 // "": labels are extracted
  std::string labels;                // "": none; else there is no input
  std::string names, merged, table;  // of labels; "": none
  std::string output;
  std::string report;     // "": none
  std::string trace;      // "": none
  std::string attach;     // "": none
  std::string init_file;  // of --init mesh= and mask=
  std::vector<plc_seed> seeds;
  std::vector<IsoChoice> isos;  // as given; the first is parameters.iso where it is a number
  std::optional<VoxelBox> box;
  KeepRule keep;
  std::vector<std::string> structure_texts;
  std::vector<Structure> structures;  // by read_structures()
  plc_parameters parameters;
  plc_context_options context;
  plc_space space = PLC_SPACE_LPS;
  NiftiFrame nifti_frame = NiftiFrame::kAuto;
  std::optional<int64_t> memory;  // bytes
  bool each_level = false;
  Progress progress = Progress::kText;

  ExtractOptions();  // the engine's defaults
};

// Declares every option of `extract`, with its default as the engine gives it, on `command`;
// parsing fills `options`, which must outlive it.
void add_extract_options(CLI::App& command, ExtractOptions& options);

// After parsing: what --structure tells, on top of the other options. Throws CLI::ValidationError.
void read_structures(ExtractOptions& options);

extern const Choices<plc_space> kSpaces;
extern const Choices<NiftiFrame> kNiftiFrames;
extern const Choices<plc_bound> kBounds;
extern const Choices<plc_anisotropy> kAnisotropies;
extern const Choices<plc_mesh_kind> kMeshes;
extern const Choices<plc_force> kForces;
extern const Choices<plc_feature> kFeatures;
extern const Choices<int> kInsides;  // plc_parameters::inside_below

// As --rest-length and --init take them.
std::string rest_length_text(const plc_parameters& parameters);
std::string init_text(const ExtractOptions& options);

}  // namespace plc::tools
