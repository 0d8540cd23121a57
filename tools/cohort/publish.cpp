#include "tools/cohort/publish.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "tools/cohort/bids.h"
#include "tools/cohort/scan_state.h"
#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"

namespace plc::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kStaged = "surface";

struct Surface {
  std::string name;  // "": the only one
  std::string staged, staged_report;
  std::string mesh, report;  // relative to the cohort's folder
  uint64_t bytes = 0;
};

std::string host_name() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "";
  return name.data();
}

Json run_json(const Scan& scan, const ScanRun& run) {
  return {{"name", scan.name},
          {"key", scan.key},
          {"input_hash", scan.hash},
          {"seconds", run.seconds},
          {"cpu_seconds", run.end.cpu_seconds},
          {"peak_rss_bytes", run.end.peak_bytes},
          {"host", host_name()},
          {"ended", static_cast<int64_t>(std::time(nullptr))}};
}

void make_folder_of(const std::string& path) {
  std::error_code error;
  const fs::path folder = fs::path(path).parent_path();
  fs::create_directories(folder, error);
  if (error) throw Failure{folder.string() + ": cannot be made: " + error.message()};
}

// What a scan says may be in any encoding.
void write_json(const std::string& path, const Json& json) {
  make_folder_of(path);
  AtomicFile file(path);
  file.write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  file.commit();
}

std::string output_of(const Manifest& manifest, const Scan& scan, const std::string& name) {
  if (name.empty()) return scan.output;
  return manifest.root.empty() ? scan.output + "/" + name : bids_surface(scan.output, name);
}

std::vector<Surface> staged_surfaces(const std::string& folder, const Manifest& manifest,
                                     const Scan& scan) {
  std::vector<Surface> surfaces;
  const std::string work = work_path(folder, scan);
  std::error_code error;
  for (fs::directory_iterator i(work, error), end; !error && i != end; i.increment(error)) {
    const std::string file = i->path().filename().string();
    if (!file.starts_with(kStaged) || !file.ends_with(manifest.suffix)) continue;
    Surface surface;
    const size_t begin = std::char_traits<char>::length(kStaged);
    const std::string middle = file.substr(begin, file.size() - begin - manifest.suffix.size());
    surface.name = middle.empty() ? "" : middle.substr(1);
    surface.staged = i->path().string();
    surface.staged_report = work;
    surface.staged_report.append("/").append(kStaged).append(middle).append(".json");
    const std::string output = output_of(manifest, scan, surface.name);
    surface.mesh = output + manifest.suffix;
    surface.report = output + ".json";
    surface.bytes = fs::file_size(i->path());
    surfaces.push_back(surface);
  }
  if (error) throw Failure{work + ": cannot be read: " + error.message()};
  std::sort(surfaces.begin(), surfaces.end(),
            [](const Surface& a, const Surface& b) { return a.name < b.name; });
  return surfaces;
}

bool is_inside(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  return normal.is_relative() && !normal.empty() && *normal.begin() != "..";
}

// Of another plan; what has the same names now is written over.
void remove_earlier(const std::string& folder, const Scan& scan,
                    const std::vector<Surface>& surfaces) {
  std::set<std::string> kept;
  for (const Surface& surface : surfaces) kept.insert({surface.mesh, surface.report});
  const std::string certificate = report_path(folder, scan);
  const Json before = json_file(certificate);
  std::error_code none;
  fs::remove(certificate, none);
  if (!before.is_object() || !before.contains("cohort")) return;
  for (const Json& surface : before["cohort"].value("surfaces", Json::array())) {
    for (const char* kind : {"mesh", "report"}) {
      const std::string path = surface.value(kind, "");
      if (!kept.contains(path) && is_inside(path)) fs::remove(fs::path(folder) / path, none);
    }
  }
}

// The report of a surface that started from another names the file where that was being made.
void name_places(Json& report, const std::vector<Surface>& surfaces) {
  if (!report.contains("parameters") || !report["parameters"].contains("init")) return;
  for (const Surface& surface : surfaces) {
    if (report["parameters"]["init"] == "mesh=" + surface.staged) {
      report["parameters"]["init"] = "mesh=" + surface.mesh;
    }
  }
}

}  // namespace

std::string staged_mesh(const std::string& folder, const Scan& scan, const Manifest& manifest) {
  return work_path(folder, scan) + "/" + kStaged + manifest.suffix;
}

std::string staged_report(const std::string& folder, const Scan& scan) {
  return work_path(folder, scan) + "/" + kStaged + ".json";
}

void publish(const std::string& folder, const Manifest& manifest, const Scan& scan,
             const ScanRun& run) {
  const std::vector<Surface> surfaces = staged_surfaces(folder, manifest, scan);
  Json cohort = run_json(scan, run);
  cohort["warnings"] = run.lines;
  cohort["surfaces"] = Json::array();
  std::set<std::string> names;
  for (const Surface& s : surfaces) {
    if (!names.insert(s.mesh).second) throw Failure{s.mesh + ": is that of two surfaces"};
    cohort["surfaces"].push_back(
        {{"name", s.name}, {"mesh", s.mesh}, {"report", s.report}, {"bytes", s.bytes}});
  }
  remove_earlier(folder, scan, surfaces);
  Json certificate;
  for (const Surface& surface : surfaces) {
    const std::string mesh = folder + "/" + surface.mesh;
    make_folder_of(mesh);
    std::error_code error;
    fs::rename(surface.staged, mesh, error);
    if (error) throw Failure{mesh + ": cannot be written: " + error.message()};
    Json report = json_file(surface.staged_report);
    name_places(report, surfaces);
    if (!manifest.root.empty()) {
      report["Sources"] = {fs::path(scan.input).lexically_relative(manifest.root).string()};
    }
    if (surface.name.empty()) {
      certificate = report;
    } else {
      write_json(folder + "/" + surface.report, report);
    }
  }
  certificate["cohort"] = cohort;
  write_json(report_path(folder, scan), certificate);
  std::error_code none;
  fs::remove(failure_path(folder, scan), none);
}

void note_failure(const std::string& folder, const Scan& scan, const ScanRun& run,
                  const std::string& error) {
  write_json(failure_path(folder, scan),
             {{"error", error}, {"input", scan.input}, {"cohort", run_json(scan, run)}});
}

}  // namespace plc::tools
