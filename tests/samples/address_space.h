// Address space without memory behind it, for volumes that no memory holds.
#pragma once
#include <sys/mman.h>

#include <catch2/catch.hpp>
#include <cstddef>

namespace samples {

// Pages that may be used as `protection` says: PROT_NONE, nobody may look at them; PROT_READ and
// PROT_WRITE, zeros, which take memory where they are written alone.
class AddressSpace {
 public:
  AddressSpace(size_t size, int protection) : size_(size) {
    data_ = mmap(nullptr, size, protection, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    REQUIRE(data_ != MAP_FAILED);
    madvise(data_, size, MADV_NOHUGEPAGE);  // a huge page of zeros that is written takes all of it
  }
  ~AddressSpace() { munmap(data_, size_); }
  AddressSpace(const AddressSpace&) = delete;
  AddressSpace& operator=(const AddressSpace&) = delete;
  void* data() const { return data_; }

 private:
  size_t size_;
  void* data_;
};

}  // namespace samples
