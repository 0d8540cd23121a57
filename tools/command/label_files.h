// The files of `pellicle extract --labels`.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "tools/command/extract_options.h"
#include "tools/command/label_piece.h"

namespace plc::tools {

// Throws Failure where a file cannot be made, or would be written twice.
void check_label_paths(const ExtractOptions& options);

// Writes a mesh of each piece that has one, OUTPUT-LABEL.SUFFIX, a report beside each, all of them
// in one mesh and the table, as the options tell, and prints a line for each. doubles: how
// coordinates are written. voxel_mm3: of a voxel. Throws Failure.
void write_label_files(const ExtractOptions& options, std::vector<LabelPiece>& pieces, bool doubles,
                       double voxel_mm3);

}  // namespace plc::tools
