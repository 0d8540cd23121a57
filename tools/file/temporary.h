// A file under a temporary name beside its target. Whatever ends the process, none is left for
// good.
#pragma once
#include <string>

namespace plc::tools {

// `.NAME.pellicle-0` for the target NAME, with a higher number where others write the same target
// at the same time. It is locked (flock) while it is in use: that tells it from what a killed
// process has left, which the next one for the same target takes away.
class Temporary {
 public:
  Temporary() = default;
  ~Temporary();  // removed, unless it has become its target
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  // The file, empty, open for writing and for nobody else to read. 0 or the value of errno.
  int make(const std::string& target);
  // Renamed; it stays open. 0 or the value of errno.
  int become(const std::string& target);
  int close();
  // -1: there is none.
  int descriptor() const { return descriptor_; }

 private:
  int create(const std::string& path);
  void forget();

  int descriptor_ = -1;
  std::string path_;  // "": it is no temporary file any more
  int note_ = -1;     // where a signal's handler finds the path; -1: nowhere
};

// For a signal's handler that ends the process: removes the temporary files of now.
void remove_temporaries();

}  // namespace plc::tools
