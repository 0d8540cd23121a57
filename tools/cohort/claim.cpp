#include "tools/cohort/claim.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "tools/file/failure.h"

namespace plc::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLock = "lock";

}  // namespace

Claim::~Claim() {
  close();
}

Claim::Claim(Claim&& other) noexcept
    : folder_(std::move(other.folder_)), lock_(std::exchange(other.lock_, -1)) {}

bool Claim::take(const std::string& folder) {
  folder_ = folder;
  std::error_code error;
  // Who has just finished removes the folder, and the lock with it: then it is made anew.
  for (;;) {
    fs::create_directories(folder, error);
    if (error) throw Failure{folder + ": cannot be made: " + error.message()};
    lock_ = open((folder + "/" + kLock).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (lock_ < 0 && errno == ENOENT) continue;
    if (lock_ < 0) {
      throw Failure{folder + ": cannot be written: " + std::generic_category().message(errno)};
    }
    if (flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close();
      return false;
    }
    struct stat status {};
    if (fstat(lock_, &status) == 0 && status.st_nlink > 0) break;
    close();
  }
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code none;
    if (entry.path().filename() != kLock) fs::remove_all(entry.path(), none);
  }
  return true;
}

void Claim::finish() {
  std::error_code none;
  fs::remove_all(folder_, none);
  close();
}

void Claim::close() {
  if (lock_ >= 0) ::close(std::exchange(lock_, -1));
}

}  // namespace plc::tools
