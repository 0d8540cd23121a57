// A ring taken out of the mesh to be read or edited: contiguous, inline up to 32 neighbours.
#pragma once
#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>

#include "pyramid/memory.h"

namespace plc {

class Neighbors {
 public:
  uint32_t size() const { return size_; }
  uint32_t* data() { return size_ <= kInline ? inline_.data() : heap_.data(); }
  const uint32_t* data() const { return size_ <= kInline ? inline_.data() : heap_.data(); }
  uint32_t operator[](uint32_t k) const {
    assert(k < size_);
    return data()[k];
  }
  uint32_t& operator[](uint32_t k) {
    assert(k < size_);
    return data()[k];
  }
  const uint32_t* begin() const { return data(); }
  const uint32_t* end() const { return data() + size_; }

  uint32_t next(uint32_t k) const { return data()[k + 1 == size_ ? 0 : k + 1]; }
  uint32_t previous(uint32_t k) const { return data()[k == 0 ? size_ - 1 : k - 1]; }
  // Position of v, or size() when it is no neighbour.
  uint32_t find(uint32_t v) const {
    return static_cast<uint32_t>(std::find(begin(), end(), v) - begin());
  }
  bool contains(uint32_t v) const { return find(v) < size_; }

  void resize(uint32_t size) {
    if (size > kInline && size_ <= kInline) {
      heap_.assign(inline_.begin(), inline_.begin() + size_);
    } else if (size <= kInline && size_ > kInline) {
      std::copy_n(heap_.begin(), size, inline_.begin());
    }
    if (size > kInline) heap_.resize(size);
    size_ = size;
  }
  void clear() { resize(0); }
  void push_back(uint32_t v) {
    resize(size_ + 1);
    data()[size_ - 1] = v;
  }
  // v becomes element k.
  void insert(uint32_t k, uint32_t v) {
    assert(k <= size_);
    resize(size_ + 1);
    uint32_t* d = data();
    std::copy_backward(d + k, d + size_ - 1, d + size_);
    d[k] = v;
  }
  void erase(uint32_t k) {
    assert(k < size_);
    uint32_t* d = data();
    std::copy(d + k + 1, d + size_, d + k);
    resize(size_ - 1);
  }

 private:
  static constexpr uint32_t kInline = 32;
  uint32_t size_ = 0;
  std::array<uint32_t, kInline> inline_;
  Vector<uint32_t> heap_;
};

}  // namespace plc
