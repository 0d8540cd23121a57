// Loops over fixed blocks: the pieces, and so every sum over them, are the same for any executor.
#pragma once
#include <algorithm>
#include <cstddef>

#include "engine/base/constants.h"
#include "kernels/ring.h"
#include "pyramid/executor.h"

namespace plc {

// Blocks of kRingLanes vertices that one task works on.
inline constexpr size_t kTaskBlocks = kGrain / kRingLanes;

inline size_t block_count(size_t count, size_t block) {
  return (count + block - 1) / block;
}

// body(index of the block, begin, end) for [0, count) in pieces of `block`.
template <typename Body>
void run_blocks(const Executor& executor, size_t count, size_t block, const Body& body) {
  executor.run(block_count(count, block), [&](size_t index) {
    body(index, index * block, std::min(count, (index + 1) * block));
  });
}

}  // namespace plc
