// Which blocks of vertices a kernel works on.
#pragma once
#include <cstddef>
#include <cstdint>

#include "kernels/ring.h"

namespace plc {

// Blocks of kRingLanes vertices, by index, ascending: block b holds the vertices kRingLanes * b and
// up. A list, or where there is none `count` blocks from `first` on. `following` more come after
// them, for another task, and may be read to have them in the caches. Borrows the list.
struct Blocks {
  const uint32_t* list = nullptr;
  size_t count = 0;
  uint32_t first = 0;
  size_t following = 0;

  // Whether there is an i-th block, of this task or of those after it.
  bool comes(size_t i) const { return i < count + following; }
  // The first vertex of the i-th block.
  uint32_t begin(size_t i) const {
    return (list == nullptr ? first + static_cast<uint32_t>(i) : list[i]) * kRingLanes;
  }
  // Items [begin, end) of a list of `size`: one task of it.
  static Blocks of(const uint32_t* list, size_t size, size_t begin, size_t end) {
    return {list + begin, end - begin, 0, size - end};
  }
  // Vertices [begin, end), both multiples of kRingLanes.
  static Blocks range(uint32_t begin, uint32_t end) {
    return {nullptr, (end - begin) / kRingLanes, begin / kRingLanes};
  }
};

}  // namespace plc
