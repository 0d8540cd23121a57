#include "tools/cohort/content.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "tools/file/failure.h"
#include "tools/file/path_suffix.h"

namespace plc::tools {
namespace {

namespace fs = std::filesystem;

std::string digits(uint64_t hash) {
  char text[20];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

[[noreturn]] void fail(const std::string& path, int error) {
  throw Failure{path + ": cannot be read: " + std::generic_category().message(error)};
}

std::string hash_of_file(const std::string& path) {
  constexpr size_t kBlock = size_t{1} << 20;
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) fail(path, errno);
  XXH64_state_t state;
  XXH64_reset(&state, 0);
  std::vector<char> block(kBlock);
  for (;;) {
    const ssize_t count = read(file, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    const int error = errno;
    if (count <= 0) close(file);
    if (count < 0) fail(path, error);
    if (count == 0) return digits(XXH64_digest(&state));
    XXH64_update(&state, block.data(), static_cast<size_t>(count));
  }
}

std::string trimmed(const std::string& text) {
  const char* space = " \t\r\n";
  const size_t begin = text.find_first_not_of(space);
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(space) + 1 - begin);
}

// Every line of a header that is the name of a file, or ends in one, names one: "ElementDataFile =
// a.raw", "data file: a.raw", and the lines of a list. Of a numbered name all that begin as it
// does.
void add_named(const fs::path& header, std::vector<std::string>& files) {
  constexpr int kMostLines = 20000;
  const fs::path folder = header.parent_path();
  std::ifstream file(header);
  std::string line;
  for (int i = 0; i < kMostLines && std::getline(file, line); ++i) {
    const size_t sign = line.find_first_of("=:");
    const std::string behind = sign == std::string::npos ? "" : trimmed(line.substr(sign + 1));
    for (const std::string& name : {trimmed(line), behind}) {
      std::error_code none;
      if (name.empty()) continue;
      if (fs::is_regular_file(folder / name, none)) files.push_back((folder / name).string());
      const size_t number = name.find('%');
      if (number == std::string::npos || number == 0) continue;
      const fs::path pattern = folder / name.substr(0, number);
      for (const auto& entry : fs::directory_iterator(pattern.parent_path(), none)) {
        const bool begins = entry.path().string().starts_with(pattern.string());
        if (begins && entry.is_regular_file(none)) files.push_back(entry.path().string());
      }
    }
  }
}

}  // namespace

std::string content_hash(std::string_view text) {
  return digits(XXH64(text.data(), text.size(), 0));
}

std::vector<std::string> files_of(const std::string& path) {
  std::error_code error;
  std::vector<std::string> files;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw Failure{path + ": there is no such file"};
  if (fs::is_directory(status)) {
    for (fs::recursive_directory_iterator i(path, error), end; !error && i != end;
         i.increment(error)) {
      std::error_code none;
      if (i->is_regular_file(none)) files.push_back(i->path().string());
    }
    if (error) fail(path, error.value());
  } else if (!fs::is_regular_file(status)) {
    throw Failure{path + ": is not a file"};
  } else {
    files.push_back(path);
    const std::string suffix = path_suffix(path);
    if (suffix == ".mhd" || suffix == ".nhdr") add_named(path, files);
  }
  std::sort(files.begin(), files.end());
  files.erase(std::unique(files.begin(), files.end()), files.end());
  return files;
}

Stamp stamp_of(const std::string& path) {
  Stamp stamp;
  for (const std::string& file : files_of(path)) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0) fail(file, errno);
    constexpr int64_t kNanoseconds = 1000000000;
    stamp.bytes += static_cast<uint64_t>(status.st_size);
    stamp.modified = std::max<int64_t>(
        stamp.modified, status.st_mtim.tv_sec * kNanoseconds + status.st_mtim.tv_nsec);
  }
  return stamp;
}

std::string hash_of(const std::string& path) {
  const std::vector<std::string> files = files_of(path);
  if (files.size() == 1 && files[0] == path) return hash_of_file(path);
  std::error_code none;
  const bool folder = fs::is_directory(path, none);
  const fs::path root = folder ? fs::path(path) : fs::path(path).parent_path();
  std::string lines;
  for (const std::string& file : files) {
    lines += hash_of_file(file) + "  " + fs::path(file).lexically_relative(root).string() + "\n";
  }
  return content_hash(lines);
}

}  // namespace plc::tools
