// The reports of a cohort as one table.
#pragma once
#include <cstddef>
#include <string>

#include "tools/cohort/manifest.h"

namespace plc::tools {

struct Collected {
  size_t rows = 0;     // a line for each surface, and for each scan without one
  size_t missing = 0;  // scans that have failed or are left
};

// Columns between tabs, n/a where there is nothing to tell; atomically. Throws Failure.
Collected collect_cohort(const std::string& folder, const Manifest& manifest,
                         const std::string& path);

}  // namespace plc::tools
