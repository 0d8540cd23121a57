// Trees as the Brain Imaging Data Structure has them, and derivatives of them.
#pragma once
#include <string>

#include "tools/cohort/plan_table.h"

namespace plc::tools {

bool is_bids(const std::string& folder);

// Every image of sub-*/[ses-*/]*/ whose name ends in _SUFFIX. Its derivative stands in the same
// folders, with desc-DESCRIPTION and the suffix mesh: sub-01/anat/sub-01_desc-pellicle_mesh.
void read_bids(const std::string& folder, const TableOptions& options, Table& table);

// The derivative of one of several surfaces of a scan: desc-NAME in place of what is there.
std::string bids_surface(const std::string& output, const std::string& name);

// Atomically: dataset_description.json, which says that and how the cohort's folder was made.
void write_description(const std::string& folder, const std::string& root,
                       const std::string& version);

}  // namespace plc::tools
