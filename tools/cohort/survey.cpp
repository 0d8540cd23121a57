#include "tools/cohort/survey.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/cohort/cohort_progress.h"
#include "tools/cohort/scan_state.h"

namespace plc::tools {
namespace {

using Json = nlohmann::ordered_json;

// Ends within so many scans' time, and within this, tell whether somebody is at work.
constexpr double kRecentScans = 20;
constexpr double kRecentSeconds = 60;

// Scans per second from when they have ended.
double pace_of(std::vector<double> ended, double mean, double now) {
  const double window = std::max(kRecentSeconds, kRecentScans * mean);
  std::sort(ended.begin(), ended.end());
  const auto first = std::lower_bound(ended.begin(), ended.end(), now - window);
  if (first == ended.end()) return 0;
  const auto count = static_cast<double>(ended.end() - first);
  // The first of them has begun before it ended.
  return count / std::max(1.0, std::min(window, now - *first + mean));
}

}  // namespace

Survey survey_of(const std::string& folder, const Manifest& manifest, std::time_t now) {
  Survey survey;
  std::vector<double> ended;
  double seconds = 0;
  double cpu_seconds = 0;
  for (const Scan& scan : manifest.scans) {
    const ScanResult result = result_of(folder, scan);
    if (result.state == ScanState::kLeft) {
      survey.left.push_back(&scan);
      continue;
    }
    const Json& cohort = result.report["cohort"];
    ended.push_back(cohort.value("ended", 0.0));
    if (result.state == ScanState::kFailed) {
      ++survey.failed;
      survey.errors.push_back(scan.name + ": " + result.report.value("error", ""));
      continue;
    }
    ++survey.done;
    const double own = cohort.value("seconds", 0.0);
    seconds += own;
    const double own_cpu = cohort.value("cpu_seconds", 0.0);
    cpu_seconds += own_cpu;
    survey.longest_cpu_seconds = std::max(survey.longest_cpu_seconds, own_cpu);
    survey.largest_input = std::max(survey.largest_input, scan.stamp.bytes);
    survey.longest_seconds = std::max(survey.longest_seconds, own);
    survey.peak_bytes = std::max(survey.peak_bytes, cohort.value("peak_rss_bytes", uint64_t{0}));
  }
  const auto done = static_cast<double>(std::max<size_t>(survey.done, 1));
  survey.mean_seconds = seconds / done;
  survey.mean_cpu_seconds = cpu_seconds / done;
  survey.pace = pace_of(ended, survey.mean_seconds, static_cast<double>(now));
  return survey;
}

std::string status_text(const Survey& survey, std::time_t now) {
  const size_t left = survey.left.size();
  std::string text = "done    " + std::to_string(survey.done) + "\nfailed  " +
                     std::to_string(survey.failed) + "\nleft    " + std::to_string(left) + "\n";
  if (survey.done > 0) {
    std::array<char, 128> line{};
    std::snprintf(line.data(), line.size(),
                  "a scan  %.1f s on average, %.1f s at most, %.0f MiB at most\n",
                  survey.mean_seconds, survey.longest_seconds,
                  static_cast<double>(survey.peak_bytes) / (1024 * 1024));
    text += line.data();
  }
  if (left > 0 && survey.pace > 0) {
    const double seconds = static_cast<double>(left) / survey.pace;
    text += "end     " + clock_text(static_cast<double>(now) + seconds) + ", in about " +
            duration_text(seconds) + " as it goes now\n";
  } else if (left > 0 && survey.done > 0) {
    text += "end     nothing ends at present; one scan after the other takes about " +
            duration_text(static_cast<double>(left) * survey.mean_seconds) + "\n";
  }
  for (const std::string& error : survey.errors) text += "failed: " + error + "\n";
  return text;
}

std::string status_json(const Survey& survey, std::time_t now) {
  Json json = {{"done", survey.done},
               {"failed", survey.failed},
               {"left", survey.left.size()},
               {"mean_seconds", survey.mean_seconds},
               {"longest_seconds", survey.longest_seconds},
               {"peak_rss_bytes", survey.peak_bytes},
               {"expected_end", nullptr},
               {"errors", survey.errors}};
  if (!survey.left.empty() && survey.pace > 0) {
    json["expected_end"] = static_cast<int64_t>(
        static_cast<double>(now) + static_cast<double>(survey.left.size()) / survey.pace);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace plc::tools
