// The curves of a run (figure 17) as CSV: one line per iteration.
#pragma once
#include <string>

#include "engine/pellicle.h"

namespace plc::tools {

// Collects lines and writes them at once; nothing is written before commit(). Throws Failure.
class TraceFile {
 public:
  explicit TraceFile(std::string path);  // "": none
  void add(const plc_progress& progress);
  void commit() const;

 private:
  std::string path_;
  std::string text_;
  int iteration_ = 0;  // over all levels
};

}  // namespace plc::tools
