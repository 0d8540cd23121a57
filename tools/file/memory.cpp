#include "tools/file/memory.h"

#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "tools/file/apart.h"
#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"

namespace plc::tools {
namespace {

std::string gibibytes(uint64_t bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f GiB", static_cast<double>(bytes) / (1024.0 * 1024 * 1024));
  return text;
}

}  // namespace

uint64_t available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string key;
  uint64_t kibibytes = 0;
  std::string unit;
  while (file >> key >> kibibytes) {
    if (key == "MemAvailable:") return kibibytes * 1024;
    std::getline(file, unit);
  }
  return 0;
}

uint64_t unshared_memory() {
  std::ifstream file("/proc/self/status");
  std::string line;
  uint64_t kibibytes = 0;
  while (std::getline(file, line)) {
    if (line.starts_with("RssAnon:") || line.starts_with("RssFile:")) {
      kibibytes += std::strtoull(line.c_str() + 8, nullptr, 10);
    }
  }
  return kibibytes * 1024;
}

void require_memory(const std::string& path, uint64_t bytes) {
  const uint64_t available = available_memory();
  if (available == 0 || bytes <= available) return;
  throw Failure{path + ": needs " + gibibytes(bytes) + " of memory, " + gibibytes(available) +
                " are available"};
}

void allow_for(uint64_t bytes) {
  constexpr double kSecondsPerByte = 5e-8;
  constexpr uint64_t kCopies = 4;  // ITK and the libraries under it keep some of their own
  raise_limits({kSecondsPerByte * static_cast<double>(bytes), times(bytes, kCopies)});
}

}  // namespace plc::tools
