// What a long run tells on stderr: one line that is rewritten on a terminal, else a line now and
// then.
#pragma once
#include "engine/pellicle.h"

namespace plc::tools {

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();  // leaves a terminal's line empty
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void update(const plc_progress& progress);
  void clear();

 private:
  bool quiet_;
  bool terminal_;
  bool written_ = false;
  double due_;  // seconds of the run at which to write next
};

}  // namespace plc::tools
