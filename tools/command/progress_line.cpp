#include "tools/command/progress_line.h"

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
constexpr double kSlicerPeriod = 0.1;
// Before this much is done an estimate of the time left means nothing.
constexpr double kFirstEstimate = 0.02;

std::string left_of(double fraction, double seconds) {
  if (fraction < kFirstEstimate) return "";
  const double left = seconds * (1 - fraction) / fraction;
  char text[48];
  if (left < 100) {
    std::snprintf(text, sizeof text, ", about %.0f s left", std::max(1.0, std::ceil(left)));
  } else {
    std::snprintf(text, sizeof text, ", about %.0f min left", std::ceil(left / 60));
  }
  return text;
}

double period_of(Progress to, bool terminal) {
  if (to == Progress::kSlicer) return kSlicerPeriod;
  return terminal ? kTerminalPeriod : kLinePeriod;
}

std::string text_of(const plc_progress& p) {
  char text[160];
  if (p.iteration == 0) {
    std::snprintf(text, sizeof text, "level %d (%d to 0), surface to start from", p.level,
                  p.levels);
    return text;
  }
  std::snprintf(text, sizeof text,
                "level %d (%d to 0), iteration %d, %" PRId64 " vertices, energy %.1e", p.level,
                p.levels, p.iteration, p.vertices, p.energy);
  return text;
}

// Slicer takes the last of each element that the output has so far.
void tell_slicer(double fraction, const std::string& comment) {
  if (!comment.empty()) std::printf("<filter-comment>%s</filter-comment>\n", comment.c_str());
  std::printf("<filter-progress>%.4f</filter-progress>\n", fraction);
  std::fflush(stdout);
}

}  // namespace

ProgressLine::ProgressLine(Progress to)
    : to_(to),
      terminal_(isatty(STDERR_FILENO) == 1),
      due_(period_of(to, terminal_)),
      part_due_(due_) {
  if (to_ != Progress::kSlicer) return;
  due_ = 0;  // the first iteration is told, however short the run
  std::fputs("<filter-start><filter-name>Pellicle</filter-name></filter-start>\n", stdout);
  tell_slicer(0, "");
}

ProgressLine::~ProgressLine() {
  clear();
}

void ProgressLine::update(const plc_progress& p) {
  update(text_of(p), p.fraction, p.seconds);
}

void ProgressLine::update(const std::string& text, double fraction, double seconds) {
  if (to_ == Progress::kNone || seconds < due_) return;
  due_ = seconds + period_of(to_, terminal_);
  if (to_ == Progress::kSlicer) {
    told_ = std::max(told_, fraction);
    tell_slicer(told_, text);
    return;
  }
  write(text + left_of(fraction, seconds));
}

void ProgressLine::update_part(const std::string& text, double fraction, double seconds) {
  if (to_ == Progress::kNone || seconds < part_due_) return;
  part_due_ = seconds + period_of(to_, terminal_);
  if (to_ == Progress::kSlicer) {
    tell_slicer(told_, text);
  } else {
    write(text + left_of(fraction, seconds));
  }
}

void ProgressLine::write(const std::string& line) {
  std::fprintf(stderr, terminal_ ? "\r\033[K%s" : "%s\n", line.c_str());
  std::fflush(stderr);
  written_ = true;
}

void ProgressLine::clear() {
  if (terminal_ && written_) std::fputs("\r\033[K", stderr);
  written_ = false;
}

void ProgressLine::done() {
  clear();
  if (to_ != Progress::kSlicer) return;
  tell_slicer(1, "");
  std::fputs("<filter-end><filter-name>Pellicle</filter-name></filter-end>\n", stdout);
  std::fflush(stdout);
}

}  // namespace plc::tools
