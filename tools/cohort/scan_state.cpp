#include "tools/cohort/scan_state.h"

#include <filesystem>
#include <fstream>
#include <system_error>

namespace plc::tools {
namespace {

using Json = nlohmann::ordered_json;

bool has_key(const Json& json, const std::string& key) {
  return json.is_object() && json.contains("cohort") && json["cohort"].is_object() &&
         json["cohort"].value("key", "") == key;
}

bool are_there(const std::string& folder, const Json& cohort) {
  for (const Json& surface : cohort.at("surfaces")) {
    std::error_code error;
    const std::string path = folder + "/" + surface.at("mesh").get<std::string>();
    const uint64_t bytes = std::filesystem::file_size(path, error);
    if (error || bytes != surface.at("bytes").get<uint64_t>()) return false;
  }
  return true;
}

}  // namespace

std::string report_path(const std::string& folder, const Scan& scan) {
  return folder + "/" + scan.output + ".json";
}

std::string failure_path(const std::string& folder, const Scan& scan) {
  return folder + "/failed/" + scan.name + ".json";
}

std::string work_path(const std::string& folder, const Scan& scan) {
  return folder + "/work/" + scan.name;
}

Json json_file(const std::string& path) {
  std::ifstream file(path);
  if (!file) return nullptr;
  Json json = Json::parse(file, nullptr, false);
  if (json.is_discarded()) return nullptr;
  return json;
}

ScanResult result_of(const std::string& folder, const Scan& scan) {
  try {
    Json report = json_file(report_path(folder, scan));
    if (has_key(report, scan.key) && are_there(folder, report["cohort"])) {
      return {ScanState::kDone, std::move(report)};
    }
    Json failure = json_file(failure_path(folder, scan));
    if (has_key(failure, scan.key)) return {ScanState::kFailed, std::move(failure)};
  } catch (const Json::exception&) {
    // Somebody has changed it: it is made again.
  }
  return {};
}

}  // namespace plc::tools
