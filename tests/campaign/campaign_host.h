// What the host of a second run lends: memory that is never zero and is counted, loops that run
// from the last task to the first, images with gaps between their voxels.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/pellicle.h"

namespace campaign {

class HostMemory {
 public:
  // As a context's allocator, which must not outlive it.
  void lend(plc_context_options& options);
  // What the engine has done wrong, or nothing: blocks given back with another size or alignment,
  // or, when all that was made is gone, not at all.
  std::string fault() const;

 private:
  static void* allocate(size_t size, size_t alignment, void* user);
  static void release(void* data, size_t size, size_t alignment, void* user);
  std::atomic<int64_t> blocks_{0};
  std::atomic<bool> wrong_size_{false};
};

void lend_backward_loops(plc_context_options& options);

// The image with two voxels of room after each row, and its rows from the last to the first, in
// bytes that must outlive it. An image that cannot be read is left as it is.
plc_image strided(const plc_image& image, std::vector<std::byte>& bytes);

}  // namespace campaign
