// From a list of scans to the manifest of a cohort.
#pragma once
#include <string>
#include <vector>

#include "tools/cohort/manifest.h"
#include "tools/cohort/plan_table.h"

namespace plc::tools {

// The parser of `extract`, which belongs to the command.
class ExtractParser {
 public:
  enum class Kind { kUnknown, kFlag, kValue };

  virtual ~ExtractParser() = default;
  // Of an option by its long name, without dashes. Unknown are those that tell files, too.
  virtual Kind kind_of(const std::string& option) const = 0;
  // Whether `extract` takes these words for an image; returns the other files that it would read.
  // Throws Failure.
  virtual std::vector<std::string> check(const std::vector<std::string>& words) const = 0;
  // The same of one word that others may have to go with.
  virtual void check_alone(const std::string& word) const = 0;
};

struct PlanOptions {
  std::string list;
  std::string folder;
  std::string mesh_suffix;  // ".ply"
  TableOptions table;
  bool labels = false;
  std::vector<std::string> words;  // options of extract for every scan: "--iso=226"
  std::string version;
  bool quiet = false;
};

// Writes the manifest, in the place of an earlier one. Throws Failure; then nothing is changed.
Manifest plan_cohort(const PlanOptions& options, const ExtractParser& parser);

}  // namespace plc::tools
