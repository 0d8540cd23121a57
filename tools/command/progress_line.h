// What a long run tells of how far it is: people on stderr, by one line that is rewritten on a
// terminal, else by a line now and then; or 3D Slicer on stdout.
#pragma once
#include <string>

#include "engine/pellicle.h"

namespace plc::tools {

enum class Progress {
  kNone,
  kText,
  kSlicer  // what Slicer looks for in the output of its command-line modules
};

class ProgressLine {
 public:
  explicit ProgressLine(Progress to);
  ~ProgressLine();  // leaves a terminal's line empty
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void update(const plc_progress& progress);
  // `text` is how far it is, `fraction` what is done.
  void update(const std::string& text, double fraction, double seconds);
  // A part of the run that is told by itself, for which `seconds` begin at 0: its text and when it
  // ends.
  void update_part(const std::string& text, double fraction, double seconds);
  void clear();
  void done();  // when all is written

 private:
  void write(const std::string& line);

  Progress to_;
  bool terminal_;
  bool written_ = false;
  double told_ = 0;  // the largest fraction so far: labels that are tried again make it fall
  double due_;       // seconds of the run at which to write next
  double part_due_;  // of a part
};

}  // namespace plc::tools
