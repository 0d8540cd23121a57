// Output files that are there whole or not at all.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace plc::tools {

// Written under another name in the target's folder, renamed by commit(), removed when commit() was
// not reached. A target that is no regular file (/dev/null, a pipe) is written directly; a link is
// followed. Everything throws Failure.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  // All that can fail on a full disk; commit() then only renames. For files that belong together.
  void finish();
  void commit();

 private:
  void flush();
  void put(const char* data, size_t size);
  [[noreturn]] void fail(int error) const;

  std::string path_;       // as the user gave it, for messages
  std::string target_;     // links followed
  std::string temporary_;  // "" when written directly
  std::string buffer_;
  int descriptor_ = -1;
};

}  // namespace plc::tools
