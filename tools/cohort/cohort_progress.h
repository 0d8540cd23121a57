// How far a cohort, or an image by blocks, is, on stderr: a line that is rewritten on a terminal,
// else one now and then.
#pragma once
#include <chrono>
#include <cstddef>
#include <string>

namespace plc::tools {

// "3 h 20 min", "12 min", "40 s".
std::string duration_text(double seconds);
// Of seconds since 1970: "2026-11-25 17:40".
std::string clock_text(double time);

class CohortProgress {
 public:
  // So many of `total`; `what`: "scans read".
  CohortProgress(std::string what, size_t total, bool quiet);
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

  std::string what_;
  size_t total_;
  bool quiet_;
  bool terminal_;
  bool written_ = false;
  double due_;  // seconds since the start
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace plc::tools
