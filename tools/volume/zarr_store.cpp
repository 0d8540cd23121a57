#include "tools/volume/zarr_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "tools/file/failure.h"

namespace plc::tools {
namespace {

class OpenFile {
 public:
  // Not blocked by a pipe without a writer.
  explicit OpenFile(const std::string& path)
      : descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {}
  ~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

[[noreturn]] void fail(const std::string& path, int error) {
  throw Failure{path + ": cannot be read: " + std::generic_category().message(error)};
}

}  // namespace

std::string ZarrFolder::name(const std::string& key) const {
  return key.empty() ? path_ : path_ + '/' + key;
}

std::optional<uint64_t> ZarrFolder::size(const std::string& key) const {
  struct stat status {};
  const std::string path = name(key);
  if (stat(path.c_str(), &status) != 0) {
    if (errno == ENOENT || errno == ENOTDIR) return std::nullopt;
    fail(path, errno);
  }
  if (!S_ISREG(status.st_mode)) throw Failure{path + ": is not a file"};
  return static_cast<uint64_t>(status.st_size);
}

void ZarrFolder::read(const std::string& key, uint64_t offset, std::span<std::byte> to) const {
  const std::string path = name(key);
  const OpenFile file(path);
  if (file.get() < 0) fail(path, errno);
  size_t done = 0;
  while (done < to.size()) {
    const ssize_t got =
        pread(file.get(), to.data() + done, to.size() - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(path, errno);
    if (got == 0) throw Failure{path + ": is truncated"};
    done += static_cast<size_t>(got);
  }
}

}  // namespace plc::tools
