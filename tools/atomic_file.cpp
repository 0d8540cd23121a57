#include "tools/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tools/volume_io.h"

namespace plc::tools {
namespace {

constexpr size_t kBufferSize = size_t{1} << 20;
constexpr mode_t kNewFileMode = 0666;  // less what the umask forbids

mode_t process_umask() {
  const mode_t mask = umask(0);
  umask(mask);
  return mask;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(path) {
  struct stat status {};
  const bool exists = stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    descriptor_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  // A file that may not be written must not be replaced either, though the folder would let us.
  if (exists && access(path.c_str(), W_OK) != 0) fail(errno);
  if (exists) {
    std::error_code error;
    target_ = std::filesystem::canonical(path, error).string();
    if (error) fail(error.value());
  }
  const std::filesystem::path target(target_);
  std::string name = (target.parent_path() / ".pellicle-XXXXXX").string();
  descriptor_ = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail(errno);
  temporary_ = std::move(name);
  const mode_t mode = exists ? (status.st_mode & 07777U) : (kNewFileMode & ~process_umask());
  (void)fchmod(descriptor_, mode);  // not every file system has modes
}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, size_t size) {
  if (buffer_.size() + size > kBufferSize) flush();
  if (size >= kBufferSize) {
    put(static_cast<const char*>(data), size);
  } else {
    buffer_.append(static_cast<const char*>(data), size);
  }
}

void AtomicFile::finish() {
  if (descriptor_ < 0) return;
  flush();
  const int descriptor = std::exchange(descriptor_, -1);
  if (close(descriptor) != 0) fail(errno);  // where some file systems report a full disk
}

void AtomicFile::commit() {
  finish();
  if (temporary_.empty()) return;
  if (rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  temporary_.clear();
}

void AtomicFile::flush() {
  put(buffer_.data(), buffer_.size());
  buffer_.clear();
}

void AtomicFile::put(const char* data, size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor_, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    data += written;
    size -= static_cast<size_t>(written);
  }
}

void AtomicFile::fail(int error) const {
  throw Failure{path_ + ": cannot be written: " + std::generic_category().message(error)};
}

}  // namespace plc::tools
