// Disjoint sets of numbers; the smallest member stands for the set.
#pragma once
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

#include "engine/base/marks.h"
#include "pyramid/memory.h"

namespace plc {

// Thread-safe, and the sets are the same in whatever order numbers are joined. What stands for a
// set is known once no thread joins.
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }
  uint32_t find(uint32_t a) {
    for (;;) {
      const uint32_t b = read_mark(parent_[a]);
      const uint32_t c = read_mark(parent_[b]);
      if (b == c) return b;
      set_mark(parent_[a], c);  // of the same set, and smaller, whatever others have joined
      a = c;
    }
  }
  void join(uint32_t a, uint32_t b) {
    for (;;) {
      a = find(a);
      b = find(b);
      if (a < b) std::swap(a, b);
      if (a == b || replace_mark(parent_[a], a, b)) return;
    }
  }

 private:
  Vector<uint32_t> parent_;
};

}  // namespace plc
