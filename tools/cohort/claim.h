// That a scan is being made by nobody else: work/NAME/, with a lock in it while it is in use.
#pragma once
#include <string>

namespace plc::tools {

// Locks are flock's: they end with the processes that hold them, whatever ended these. Where a file
// system has none, nobody is seen, and two that make the same scan make it twice.
class Claim {
 public:
  Claim() = default;
  ~Claim();  // given back; what is in the folder stays
  Claim(Claim&& other) noexcept;
  Claim& operator=(Claim&&) = delete;
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

  // The folder, empty. False: another process has it. Throws Failure.
  bool take(const std::string& folder);
  // Removes the folder and gives it back.
  void finish();
  int descriptor() const { return lock_; }

 private:
  void close();

  std::string folder_;
  int lock_ = -1;
};

}  // namespace plc::tools
