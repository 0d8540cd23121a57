// How a cohort stands, counted from its files.
#pragma once
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string>
#include <vector>

#include "tools/cohort/manifest.h"

namespace plc::tools {

struct Survey {
  size_t done = 0, failed = 0;
  std::vector<const Scan*> left;
  std::vector<std::string> errors;  // "NAME: ERROR" of what has failed
  // Of what is done, and zero where nothing is.
  double mean_seconds = 0, longest_seconds = 0;
  double mean_cpu_seconds = 0, longest_cpu_seconds = 0;
  uint64_t peak_bytes = 0;
  uint64_t largest_input = 0;  // bytes
  // Done or failed per second of late; 0: nobody is at work.
  double pace = 0;
};

Survey survey_of(const std::string& folder, const Manifest& manifest, std::time_t now);

// A few lines for people: done, failed, left, and when the rest will be.
std::string status_text(const Survey& survey, std::time_t now);
std::string status_json(const Survey& survey, std::time_t now);

}  // namespace plc::tools
