#include "tools/file/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <map>
#include <system_error>

#include "tools/file/failure.h"

namespace plc::tools {
namespace {

constexpr size_t kBufferSize = size_t{1} << 20;
constexpr mode_t kNewFileMode = 0666;  // less what the umask forbids

mode_t process_umask() {
  const mode_t mask = umask(0);
  umask(mask);
  return mask;
}

// Of fsync: pipes and devices, and some file systems. What can be done is done then.
bool has_no_sync(int error) {
  return error == EINVAL || error == ENOTSUP || error == ENOSYS || error == EROFS;
}

// From so many files on it is faster to wait for all that goes to the disk than for each of them.
constexpr size_t kMany = 8;

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(path) {
  struct stat status {};
  const bool exists = stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail(EISDIR);
  if (exists && !S_ISREG(status.st_mode)) {
    direct_ = open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (direct_ < 0) fail(errno);
    return;
  }
  // A file that may not be written must not be replaced either, though the folder would let us.
  if (exists && access(path.c_str(), W_OK) != 0) fail(errno);
  if (exists) {
    std::error_code error;
    target_ = std::filesystem::canonical(path, error).string();
    if (error) fail(error.value());
  }
  if (const int error = temporary_.make(target_); error != 0) fail(error);
  const mode_t mode = exists ? (status.st_mode & 07777U) : (kNewFileMode & ~process_umask());
  (void)fchmod(descriptor(), mode);  // not every file system has modes
}

AtomicFile::~AtomicFile() {
  if (direct_ >= 0) close(direct_);
}

void AtomicFile::write(const void* data, size_t size) {
  if (buffer_.size() + size > kBufferSize) flush();
  if (size >= kBufferSize) {
    put(static_cast<const char*>(data), size);
  } else {
    buffer_.append(static_cast<const char*>(data), size);
  }
}

void AtomicFile::commit() {
  flush();
  sync();
  rename();
  sync_folder();
}

void AtomicFile::sync() const {
  if (fsync(descriptor()) != 0 && !has_no_sync(errno)) fail(errno);
}

void AtomicFile::sync_file_system() const {
  if (syncfs(descriptor()) != 0 && !has_no_sync(errno)) fail(errno);
}

std::string AtomicFile::folder() const {
  const std::filesystem::path folder = std::filesystem::path(target_).parent_path();
  return folder.empty() ? "." : folder.string();
}

void AtomicFile::sync_folder() const {
  if (direct_ >= 0) return;
  const int descriptor = open(folder().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;  // a folder that may be written but not read
  const int error = fsync(descriptor) == 0 ? 0 : errno;
  close(descriptor);
  if (error != 0 && !has_no_sync(error)) fail(error);
}

void AtomicFile::rename() {
  if (direct_ >= 0) return;
  if (const int error = temporary_.become(target_); error != 0) fail(error);
  // Where some file systems report a full disk.
  if (const int error = temporary_.close(); error != 0) fail(error);
}

void AtomicFile::flush() {
  put(buffer_.data(), buffer_.size());
  buffer_ = {};  // many files may wait to be renamed
}

void AtomicFile::put(const char* data, size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor(), data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(errno);
    data += written;
    size -= static_cast<size_t>(written);
  }
}

void AtomicFile::fail(int error) const {
  throw Failure{path_ + ": cannot be written: " + std::generic_category().message(error)};
}

void AtomicFiles::commit() {
  std::map<std::string, const AtomicFile*> folders;  // one file of each
  for (AtomicFile& file : files_) {
    file.flush();
    if (file.direct_ < 0) folders.emplace(file.folder(), &file);
  }
  if (files_.size() < kMany) {
    for (const AtomicFile& file : files_) file.sync();
  } else {
    for (const auto& [folder, file] : folders) file->sync_file_system();
  }
  for (AtomicFile& file : files_) file.rename();
  for (const auto& [folder, file] : folders) file->sync_folder();
  files_.clear();
}

}  // namespace plc::tools
