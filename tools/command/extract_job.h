// The surfaces that one call of `extract` makes: one, one per iso-value, or one per structure.
#pragma once
#include <string>
#include <vector>

#include "tools/command/extract_options.h"

namespace plc::tools {

struct ExtractJob {
  plc_parameters parameters;  // iso: once resolve() has been called
  IsoChoice iso;              // "": none
  std::string output;
  std::string report;    // "": none
  std::string trace;     // "": none
  bool follows = false;  // the next iso-value: may start from the result of the job before
};

// head.ply becomes head-NAME.ply where there are several.
std::string named(const std::string& path, const std::string& name);

// Puts the value of the job's iso among its parameters. Throws Failure.
void resolve(ExtractJob& job, const Voxels& voxels);

// In the order in which they run. Throws Failure where two would write the same file.
std::vector<ExtractJob> jobs_of(const ExtractOptions& options);

// Whether fewer voxels lie between the two values than the object of `to` holds:
// then its surface is nearer to that of `from` than to a bubble around it (figure 24).
bool nearer(const Voxels& voxels, double from, double to, bool inside_below);

}  // namespace plc::tools
