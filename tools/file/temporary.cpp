#include "tools/file/temporary.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <utility>

namespace plc::tools {
namespace {

// ---- what a signal's handler reads

enum State : int { kFree, kTaken, kMaking, kMade };

// More files than these are open at once only where signals wait for them.
constexpr int kNotes = 8;

struct Note {
  std::atomic<int> state{kFree};
  char path[PATH_MAX] = {};
};

// A process has one set of handlers.
Note notes[kNotes];

int new_note(const std::string& path) {
  if (path.size() >= sizeof notes[0].path) return -1;
  for (int i = 0; i < kNotes; ++i) {
    int free = kFree;
    if (!notes[i].state.compare_exchange_strong(free, kTaken)) continue;
    std::memcpy(notes[i].path, path.c_str(), path.size() + 1);
    notes[i].state = kMaking;
    return i;
  }
  return -1;
}

// ---- files

// How many numbers are looked at for leftovers, in any case.
constexpr int kSwept = 4;
constexpr int kMost = 10000;

// Removes the file unless somebody holds it. Only calls that a signal's handler may make.
void take_away(const char* path) {
  const int file = open(path, O_WRONLY | O_NONBLOCK | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) return;
  struct stat status {};
  if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && flock(file, LOCK_EX | LOCK_NB) == 0) {
    unlink(path);
  }
  close(file);
}

std::string name_of(const std::filesystem::path& folder, std::string name, int number) {
  const std::string suffix = ".pellicle-" + std::to_string(number);
  const long room = pathconf(folder.c_str(), _PC_NAME_MAX);
  const size_t most = room > 0 ? static_cast<size_t>(room) : NAME_MAX;
  if (1 + name.size() + suffix.size() > most) {
    char hash[24];
    std::snprintf(hash, sizeof hash, "-%016zx", std::hash<std::string>()(name));
    size_t end = most - std::min(most, 1 + std::strlen(hash) + suffix.size());
    // Not within a character of UTF-8: some file systems refuse that.
    while (end > 0 && (static_cast<unsigned char>(name[end]) & 0xC0U) == 0x80U) --end;
    name = name.substr(0, end) + hash;
  }
  return "." + name + suffix;
}

}  // namespace

Temporary::~Temporary() {
  if (!path_.empty()) unlink(path_.c_str());
  forget();
  close();
}

int Temporary::make(const std::string& target) {
  const std::filesystem::path path(target);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  for (int number = 0; number < kMost; ++number) {
    if (descriptor_ >= 0 && number >= kSwept) return 0;
    const std::string name = path.parent_path() / name_of(folder, path.filename(), number);
    take_away(name.c_str());
    if (descriptor_ >= 0) continue;
    const int error = create(name);
    if (error != 0 && error != EEXIST) return error;
  }
  return EEXIST;
}

int Temporary::create(const std::string& path) {
  for (;;) {
    note_ = new_note(path);
    descriptor_ = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor_ < 0) {
      const int error = errno;
      forget();
      return error;
    }
    if (note_ >= 0) notes[note_].state = kMade;
    // Waits for one that has just found the file and looks whether it is a leftover. Where a file
    // system has no locks, nothing is ever taken for one.
    while (flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
    }
    struct stat status {};
    if (fstat(descriptor_, &status) != 0 || status.st_nlink > 0) break;
    forget();  // it was taken for one
    close();
  }
  path_ = path;
  return 0;
}

int Temporary::become(const std::string& target) {
  if (rename(path_.c_str(), target.c_str()) != 0) return errno;
  path_.clear();
  forget();
  return 0;
}

int Temporary::close() {
  if (descriptor_ < 0) return 0;
  return ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno;
}

void Temporary::forget() {
  if (note_ >= 0) notes[std::exchange(note_, -1)].state = kFree;
}

void remove_temporaries() {
  for (const Note& note : notes) {
    const int state = note.state;
    if (state == kMade) unlink(note.path);
    // Made, perhaps, but not locked yet; or somebody else's, and locked.
    if (state == kMaking) take_away(note.path);
  }
}

}  // namespace plc::tools
