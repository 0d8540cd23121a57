// From the folder in which a scan has been made to its place in the cohort, and what is noted of
// one that could not be made.
#pragma once
#include <string>
#include <vector>

#include "tools/cohort/child.h"
#include "tools/cohort/manifest.h"

namespace plc::tools {

// What running it has cost, and where.
struct ScanRun {
  ChildEnd end;
  double seconds = 0;
  std::vector<std::string> lines;  // that it has said on stderr
};

// The file in work/NAME/ that `extract` is told to write; names of surfaces go before the suffix.
std::string staged_mesh(const std::string& folder, const Scan& scan, const Manifest& manifest);
std::string staged_report(const std::string& folder, const Scan& scan);

// Surfaces and reports, and last what certifies them; surfaces of an earlier plan of the scan are
// removed. Throws Failure.
void publish(const std::string& folder, const Manifest& manifest, const Scan& scan,
             const ScanRun& run);

// failed/NAME.json. Throws Failure.
void note_failure(const std::string& folder, const Scan& scan, const ScanRun& run,
                  const std::string& error);

}  // namespace plc::tools
