// Bytes taken for numbers, and a file that is in memory only.
#pragma once
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <bit>
#include <cstring>
#include <string>

#include "tests/fuzz/targets.h"

namespace fuzz {

// Takes numbers from the end of the bytes, so that what is left at their front - a file, a state -
// stays where it is when there are more of them. 0 where none are left.
class Input {
 public:
  explicit Input(Bytes bytes) : bytes_(bytes) {}

  bool empty() const { return bytes_.empty(); }
  Bytes rest() const { return bytes_; }

  template <typename T>
  T raw() {
    T value{};
    const size_t size = bytes_.size() < sizeof(T) ? bytes_.size() : sizeof(T);
    if (size > 0) std::memcpy(&value, bytes_.data() + bytes_.size() - size, size);
    bytes_ = bytes_.first(bytes_.size() - size);
    return value;
  }
  // 0 .. limit - 1.
  uint32_t below(uint32_t limit) {
    return limit <= 256 ? raw<uint8_t>() % limit : raw<uint32_t>() % limit;
  }
  bool flag() { return (raw<uint8_t>() & 1) != 0; }
  // Within low .. high, in 2^16 steps.
  double within(double low, double high) {
    return low + (high - low) * (static_cast<double>(raw<uint16_t>()) / 65535.0);
  }
  template <typename T, size_t kCount>
  T one_of(const T (&choices)[kCount]) {
    return choices[below(kCount)];
  }

 private:
  Bytes bytes_;
};

inline void require(bool holds, const std::string& what) {
  if (!holds) throw Broken(what);
}

// Holds other bytes for each input, under a path that readers can open.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(memfd_create("pellicle-fuzz", MFD_CLOEXEC)) {
    require(descriptor_ >= 0, "no file in memory");
  }
  ~MemoryFile() { close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
  void put(Bytes bytes) const {
    require(ftruncate(descriptor_, 0) == 0, "the file in memory cannot be emptied");
    const auto written = pwrite(descriptor_, bytes.data(), bytes.size(), 0);
    require(written == static_cast<ssize_t>(bytes.size()), "the file in memory cannot be written");
  }

 private:
  int descriptor_;
};

}  // namespace fuzz
