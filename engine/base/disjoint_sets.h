// Disjoint sets of numbers; the smallest member stands for the set.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>

#include "pyramid/memory.h"

namespace plc {

class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  uint32_t find(uint32_t a) {
    while (parent_[a] != a) a = parent_[a] = parent_[parent_[a]];
    return a;
  }
  void join(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  Vector<uint32_t> parent_;
};

}  // namespace plc
