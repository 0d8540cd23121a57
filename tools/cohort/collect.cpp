#include "tools/cohort/collect.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "tools/cohort/scan_state.h"
#include "tools/file/atomic_file.h"

namespace plc::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kNothing = "n/a";

// A column and where its value stands in a report.
struct Column {
  const char* name;
  const char* pointer;
};
constexpr Column kOfReport[] = {
    {"iso", "/parameters/iso"},    {"vertices", "/surface/vertices"},
    {"faces", "/surface/faces"},   {"components", "/surface/components"},
    {"euler", "/surface/euler"},   {"genus", "/surface/genus"},
    {"area_mm2", "/surface/area"}, {"volume_mm3", "/surface/volume"},
};
constexpr Column kOfCost[] = {
    {"seconds_read", "/seconds/read"},
    {"seconds_pyramid", "/seconds/pyramid"},
    {"seconds_evolution", "/seconds/evolution"},
    {"seconds_write", "/seconds/write"},
    {"threads", "/threads"},
};
// Of the entry "cohort": once for a scan, however many surfaces it has.
constexpr Column kOfRun[] = {
    {"seconds_scan", "/seconds"},
    {"peak_rss_bytes", "/peak_rss_bytes"},
    {"threads", "/threads"},
    {"host", "/host"},
};

std::string cell(std::string text) {
  const auto is_break = [](char c) { return c == '\t' || c == '\n' || c == '\r'; };
  std::replace_if(text.begin(), text.end(), is_break, ' ');
  return text.empty() ? kNothing : text;
}

std::string cell_of(const Json& json) {
  if (json.is_null()) return kNothing;
  if (json.is_string()) return cell(json.get<std::string>());
  return json.dump();
}

std::string value_at(const Json& json, const char* pointer) {
  const Json::json_pointer place(pointer);
  return json.is_object() && json.contains(place) ? cell_of(json.at(place)) : kNothing;
}

// Whether every level has come to rest; "n/a" where there are none.
std::string converged(const Json& report) {
  if (!report.is_object() || !report.contains("levels")) return kNothing;
  for (const Json& level : report["levels"]) {
    if (level.value("vertices", 0) > 0 && !level.value("converged", false)) return "false";
  }
  return "true";
}

std::string sites(const Json& report) {
  if (!report.is_object() || !report.contains("sites")) return kNothing;
  return std::to_string(report["sites"].size());
}

std::string joined(const Json& lines) {
  std::string text;
  for (const Json& line : lines) {
    if (!text.empty()) text += "; ";
    text += line.get<std::string>();
  }
  return cell(text);
}

std::string line_of_cells(const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) {
    if (!line.empty()) line += '\t';
    line += cell;
  }
  return line + "\n";
}

std::string header() {
  std::vector<std::string> cells = {"name", "surface", "state", "mesh"};
  for (const Column& c : kOfReport) cells.emplace_back(c.name);
  cells.insert(cells.end(), {"converged", "sites", "hash"});
  for (const Column& c : kOfCost) cells.emplace_back(c.name);
  for (const Column& c : kOfRun) cells.emplace_back(c.name);
  cells.insert(cells.end(), {"input", "input_hash", "key", "error", "warnings"});
  return line_of_cells(cells);
}

std::string line_of(const Scan& scan, const ScanResult& result, const Json& surface,
                    const Json& report) {
  static const char* const states[] = {"left", "done", "failed"};
  const Json nothing = Json::object();
  const Json& run = result.report.is_object() ? result.report["cohort"] : nothing;
  std::vector<std::string> cells = {cell(scan.name), value_at(surface, "/name"),
                                    states[static_cast<size_t>(result.state)],
                                    value_at(surface, "/mesh")};
  for (const Column& c : kOfReport) cells.push_back(value_at(report, c.pointer));
  cells.insert(cells.end(), {converged(report), sites(report), value_at(report, "/hash")});
  for (const Column& c : kOfCost) cells.push_back(value_at(report, c.pointer));
  for (const Column& c : kOfRun) cells.push_back(value_at(run, c.pointer));
  const bool failed = result.state == ScanState::kFailed;
  cells.insert(cells.end(), {cell(scan.input), scan.hash, scan.key,
                             failed ? value_at(result.report, "/error") : kNothing,
                             joined(run.value("warnings", Json::array()))});
  return line_of_cells(cells);
}

}  // namespace

Collected collect_cohort(const std::string& folder, const Manifest& manifest,
                         const std::string& path) {
  Collected collected;
  AtomicFile file(path);
  file.write(header());
  for (const Scan& scan : manifest.scans) {
    const ScanResult result = result_of(folder, scan);
    if (result.state != ScanState::kDone) {
      file.write(line_of(scan, result, Json::object(), nullptr));
      ++collected.rows;
      ++collected.missing;
      continue;
    }
    for (const Json& surface : result.report["cohort"]["surfaces"]) {
      const bool only = surface.value("name", "").empty();
      const Json report =
          only ? result.report : json_file(folder + "/" + surface.value("report", ""));
      file.write(line_of(scan, result, surface, report));
      ++collected.rows;
    }
  }
  file.commit();
  return collected;
}

}  // namespace plc::tools
