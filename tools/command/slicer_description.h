// `pellicle extract` as a command-line module of 3D Slicer (the Slicer Execution Model): a program
// that describes its options as XML when it is asked for --xml, and that Slicer starts with those.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace plc::tools {

// Declares --xml and --xml-labels on `extract`, after all other options, from which the
// descriptions of a module for images and of one for label images are made: parsing it throws
// CLI::CallForVersion with the description as its text.
void add_slicer_option(CLI::App& extract);

// Slicer takes only names of letters, digits and underscores: --level_iso becomes --level-iso.
void accept_slicer_names(std::vector<std::string>& arguments);

}  // namespace plc::tools
