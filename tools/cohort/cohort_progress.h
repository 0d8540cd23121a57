// How far a cohort is, on stderr: a line that is rewritten on a terminal, else one now and then.
#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace plc::tools {

// "3 h 20 min", "12 min", "40 s".
std::string duration_text(double seconds);

class CohortProgress {
 public:
  // `what` has been done with so many of `total` scans, or other things.
  CohortProgress(std::string what, size_t total, bool quiet, std::string things = "scans");
  ~CohortProgress();  // leaves a terminal's line empty
  CohortProgress(const CohortProgress&) = delete;
  CohortProgress& operator=(const CohortProgress&) = delete;

  // `note` goes to the end of the line.
  void update(size_t done, const std::string& note);
  // A line that stays.
  void tell(const std::string& line);
  double seconds() const;

 private:
  void clear();

  std::string what_, things_;
  size_t total_;
  bool quiet_;
  bool terminal_;
  bool written_ = false;
  double due_;  // seconds since the start
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace plc::tools
