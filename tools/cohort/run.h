// A share of a cohort, scan by scan.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/cohort/manifest.h"

namespace plc::tools {

struct RunOptions {
  std::string folder;
  int part = 1, parts = 1;  // every parts-th scan, from the part-th on
  std::string scans;        // a file of names, a line each: only these; "": all
  bool retry_failed = false;
  int jobs = 1;         // scans at once
  int threads = 0;      // of each; 0: the cores divided among them
  uint64_t memory = 0;  // bytes for all of them; 0: what the machine has left
  bool quiet = false;
};

struct RunEnd {
  size_t done = 0;     // now
  size_t failed = 0;   // now
  size_t skipped = 0;  // done or failed before
  size_t left = 0;     // interrupted
  double seconds = 0;
  std::vector<std::string> changed;  // done before, of an input that has changed since
};

// Every name of a file of names, in the manifest's order. Throws Failure for one that is not in it.
std::vector<const Scan*> chosen_scans(const Manifest& manifest, const std::string& names);

// `interrupted`: asked often; then scans that are being made end, and no other begins. What fails
// for a scan is noted as its failure; Failure is thrown where the cohort's folder cannot be
// written.
RunEnd run_cohort(const RunOptions& options, const Manifest& manifest,
                  const std::function<bool()>& interrupted);

}  // namespace plc::tools
