// The plan of a cohort: DIR/cohort.json, a line for each scan.
#pragma once
#include <string>
#include <vector>

#include "tools/cohort/content.h"

namespace plc::tools {

struct Scan {
  std::string name;
  std::string input;  // an absolute path
  Stamp stamp;
  std::string hash;                  // of the input
  std::vector<std::string> options;  // of `extract`, a word each
  // Where the surface goes, and beside it its report: in the cohort's folder, without a suffix.
  std::string output;
  // Of the input, the options that change results, the files that these name, and Pellicle's
  // version: what has been made under the same key need not be made again.
  std::string key;
};

struct Manifest {
  std::string version;  // Pellicle's, that planned it
  std::string suffix;   // of the meshes
  std::string root;     // of the BIDS tree that the inputs are in; "": in none
  bool labels = false;  // the inputs are label images
  std::vector<Scan> scans;
};

// Throws Failure unless it is UTF-8, which JSON is.
void require_utf8(const std::string& text);

// Of the scan and all that it is made with but the scan itself.
std::string key_of(const Scan& scan, const Manifest& manifest,
                   const std::vector<std::string>& hashes_of_files);

// Atomically. Throws Failure.
void write_manifest(const std::string& folder, const Manifest& manifest);
// Throws Failure also where another version has planned it.
Manifest read_manifest(const std::string& folder, const std::string& version);

}  // namespace plc::tools
