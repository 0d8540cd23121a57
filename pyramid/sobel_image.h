// The Sobel gradient of a whole image, a row at a time (paper, 3.8).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "pyramid/executor.h"

namespace plc {

// The gradient of one row of the image; the row's first voxel has index `first`.
struct GradientRow {
  size_t first = 0;
  size_t width = 0;
  const float* gx = nullptr;
  const float* gy = nullptr;
  const float* gz = nullptr;
};

// Calls use(row) for every row of `image` (x fastest), by slices on the executor: the Sobel
// gradient (kernels/sobel.h) times `scale` per axis, borders replicated. `use` must write to
// places of that row alone. Returns false when memory for a slice's rows could not be had.
bool sobel_image(const float* image, const std::array<int64_t, 3>& dims,
                 const std::array<float, 3>& scale, const Executor& executor,
                 const std::function<void(const GradientRow&)>& use);

}  // namespace plc
