// Memory that goes from one process to another without being copied: segments of System V, as files
// in memory (memfd_create) fall under the limit of file sizes.
#pragma once
#include <sys/types.h>

#include <cstddef>

namespace plc::tools {

class SharedBytes {
 public:
  SharedBytes() = default;
  // Zeros. Throws std::bad_alloc.
  explicit SharedBytes(size_t size);
  // What another process has made, which must still have it. Throws std::bad_alloc.
  static SharedBytes received(int id, pid_t maker);
  ~SharedBytes();
  SharedBytes(SharedBytes&& other) noexcept;
  SharedBytes& operator=(SharedBytes&& other) noexcept;
  SharedBytes(const SharedBytes&) = delete;
  SharedBytes& operator=(const SharedBytes&) = delete;

  std::byte* data() { return data_; }
  const std::byte* data() const { return data_; }
  size_t size() const { return size_; }
  const std::byte* begin() const { return data_; }
  const std::byte* end() const { return data_ + size_; }
  bool empty() const { return size_ == 0; }
  // For received(); -1 where it is empty.
  int id() const { return id_; }

 private:
  void attach();

  std::byte* data_ = nullptr;
  size_t size_ = 0;
  int id_ = -1;
};

}  // namespace plc::tools
