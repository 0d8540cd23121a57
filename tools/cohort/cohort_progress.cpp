#include "tools/cohort/cohort_progress.h"

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <utility>

namespace plc::tools {
namespace {

constexpr double kTerminalPeriod = 0.1;  // seconds
constexpr double kLinePeriod = 5;

}  // namespace

std::string duration_text(double seconds) {
  constexpr double kMinute = 60;
  constexpr double kHour = 3600;
  std::array<char, 64> text{};
  if (seconds < 2 * kMinute) {
    std::snprintf(text.data(), text.size(), "%.0f s", std::ceil(seconds));
  } else if (seconds < 2 * kHour) {
    std::snprintf(text.data(), text.size(), "%.0f min", std::ceil(seconds / kMinute));
  } else {
    const double hours = std::floor(seconds / kHour);
    std::snprintf(text.data(), text.size(), "%.0f h %.0f min", hours,
                  std::floor((seconds - hours * kHour) / kMinute));
  }
  return text.data();
}

std::string clock_text(double time) {
  const auto whole = static_cast<std::time_t>(time);
  std::tm local{};
  localtime_r(&whole, &local);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M", &local);
  return text.data();
}

CohortProgress::CohortProgress(std::string what, size_t total, bool quiet)
    : what_(std::move(what)),
      total_(total),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      due_(terminal_ ? kTerminalPeriod : kLinePeriod) {}

CohortProgress::~CohortProgress() {
  clear();
}

double CohortProgress::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void CohortProgress::update(size_t done, const std::string& note) {
  const double now = seconds();
  if (quiet_ || now < due_) return;
  due_ = now + (terminal_ ? kTerminalPeriod : kLinePeriod);
  std::string line = std::to_string(done) + " of " + std::to_string(total_) + " " + what_ + note;
  if (done > 0 && done < total_) {
    const double left = now * static_cast<double>(total_ - done) / static_cast<double>(done);
    line += ", about " + duration_text(left) + " left";
  }
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", line.c_str());
  std::fflush(stderr);
  written_ = true;
}

void CohortProgress::tell(const std::string& line) {
  clear();
  std::fprintf(stderr, "pellicle: %s\n", line.c_str());
}

void CohortProgress::clear() {
  if (terminal_ && written_) std::fputs("\r\033[K", stderr);
  written_ = false;
}

}  // namespace plc::tools
