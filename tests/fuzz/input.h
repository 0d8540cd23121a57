// Bytes taken for numbers, and for a file.
#pragma once
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

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

// A file, alone in a folder of its own, that holds other bytes for each input.
class ScratchFile {
 public:
  ScratchFile() {
    std::string folder = (std::filesystem::temp_directory_path() / "pellicle-fuzz-XXXXXX").string();
    require(mkdtemp(folder.data()) != nullptr, "no folder for a file");
    folder_ = folder;
  }
  ~ScratchFile() {
    std::error_code error;
    std::filesystem::remove_all(folder_, error);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  std::string path() const { return (folder_ / "a").string(); }
  void put(Bytes bytes) const {
    std::ofstream file(path(), std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    require(file.good(), "the file cannot be written");
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace fuzz
