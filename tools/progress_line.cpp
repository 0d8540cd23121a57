#include "tools/progress_line.h"

#include <unistd.h>
#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <string>

namespace plc::tools {

namespace {

constexpr double kTerminalPeriod = 0.1;  // seconds
constexpr double kLinePeriod = 2;
// Before this much is done an estimate of the time left means nothing.
constexpr double kFirstEstimate = 0.02;

std::string left_of(const plc_progress& p) {
  if (p.fraction < kFirstEstimate) return "";
  const double left = p.seconds * (1 - p.fraction) / p.fraction;
  char text[48];
  if (left < 100) {
    std::snprintf(text, sizeof text, ", about %.0f s left", std::max(1.0, std::ceil(left)));
  } else {
    std::snprintf(text, sizeof text, ", about %.0f min left", std::ceil(left / 60));
  }
  return text;
}

}  // namespace

ProgressLine::ProgressLine(bool quiet)
    : quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      due_(terminal_ ? kTerminalPeriod : kLinePeriod) {}

ProgressLine::~ProgressLine() {
  clear();
}

void ProgressLine::update(const plc_progress& p) {
  if (quiet_ || p.seconds < due_) return;
  due_ = p.seconds + (terminal_ ? kTerminalPeriod : kLinePeriod);
  char text[160];
  std::snprintf(text, sizeof text,
                "level %d (%d to 0), iteration %d, %" PRId64 " vertices, energy %.1e%s", p.level,
                p.levels, p.iteration, p.vertices, p.energy, left_of(p).c_str());
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", text);
  std::fflush(stderr);
  written_ = true;
}

void ProgressLine::clear() {
  if (terminal_ && written_) std::fputs("\r\033[K", stderr);
  written_ = false;
}

}  // namespace plc::tools
