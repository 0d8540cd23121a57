// What has become of a scan, as the files of the cohort's folder tell. There:
//   OUTPUT.json        what certifies that a scan is done, written last: its report - or, where it
//                      has several surfaces, their list - with an entry "cohort"
//   OUTPUT.SUFFIX      its surface; of several, OUTPUT/SURFACE.SUFFIX, and the report of each
//   failed/NAME.json   the error of a scan that failed
//   work/NAME/         where a scan is being made; a lock in it says by whom
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/cohort/manifest.h"

namespace plc::tools {

enum class ScanState { kLeft, kDone, kFailed };

struct ScanResult {
  ScanState state = ScanState::kLeft;
  nlohmann::ordered_json report;  // that certifies it, or the error's; null where it is left
};

std::string report_path(const std::string& folder, const Scan& scan);
std::string failure_path(const std::string& folder, const Scan& scan);
std::string work_path(const std::string& folder, const Scan& scan);

// Done and failed are only what has the scan's present key; done also needs every surface to be
// there, as large as it was.
ScanResult result_of(const std::string& folder, const Scan& scan);

// Null where there is no such file, or it is no JSON.
nlohmann::ordered_json json_file(const std::string& path);

}  // namespace plc::tools
