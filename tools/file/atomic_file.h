// Output files that are there whole or not at all.
#pragma once
#include <cstddef>
#include <list>
#include <string>
#include <string_view>

#include "tools/file/temporary.h"

namespace plc::tools {

// Written under another name in the target's folder, renamed by commit(), removed when commit() was
// not reached. A target that is no regular file (/dev/null, a pipe) is written directly; a link is
// followed. What commit() has renamed lasts when the power fails. Everything throws Failure.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, size_t size);
  void write(std::string_view text) { write(text.data(), text.size()); }
  void commit();

 private:
  friend class AtomicFiles;
  void flush();
  void put(const char* data, size_t size);
  void sync() const;
  void sync_file_system() const;
  void sync_folder() const;
  std::string folder() const;
  void rename();
  int descriptor() const { return direct_ >= 0 ? direct_ : temporary_.descriptor(); }
  [[noreturn]] void fail(int error) const;

  std::string path_;    // as the user gave it, for messages
  std::string target_;  // links followed
  std::string buffer_;
  Temporary temporary_;
  int direct_ = -1;  // the descriptor of a target that is no regular file
};

// Files that belong together, or many of them: all is written before the first is renamed, and the
// disk is waited for once.
class AtomicFiles {
 public:
  AtomicFile& add(const std::string& path) { return files_.emplace_back(path); }
  size_t size() const { return files_.size(); }
  // In the order in which they were added; none is left.
  void commit();

 private:
  std::list<AtomicFile> files_;
};

}  // namespace plc::tools
