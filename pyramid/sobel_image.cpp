#include "pyramid/sobel_image.h"

#include <algorithm>

#include "kernels/sobel.h"
#include "pyramid/buffer.h"
#include "pyramid/guarded_run.h"

namespace plc {

namespace {

// The rows around row y of plane z; at a border that of the border again.
std::array<const float*, 9> rows_around(const float* image, const std::array<int64_t, 3>& dims,
                                        int64_t y, int64_t z) {
  std::array<const float*, 9> rows{};
  for (int64_t k = 0; k < 3; ++k) {
    const int64_t plane = std::clamp<int64_t>(z + k - 1, 0, dims[2] - 1);
    for (int64_t j = 0; j < 3; ++j) {
      const int64_t row = std::clamp<int64_t>(y + j - 1, 0, dims[1] - 1);
      rows[static_cast<size_t>(3 * k + j)] = image + (plane * dims[1] + row) * dims[0];
    }
  }
  return rows;
}

}  // namespace

bool sobel_image(const float* image, const std::array<int64_t, 3>& dims,
                 const std::array<float, 3>& scale, const Executor& executor,
                 const std::function<void(const GradientRow&)>& use) {
  const auto width = static_cast<size_t>(dims[0]);
  return run_guarded(executor, static_cast<size_t>(dims[2]), [&](size_t slice) {
    const auto z = static_cast<int64_t>(slice);
    Buffer<float> scratch, gx, gy, gz;
    scratch.resize_uninitialized(kernels::sobel_scratch(width));
    for (Buffer<float>* row : {&gx, &gy, &gz}) row->resize_uninitialized(width);
    for (int64_t y = 0; y < dims[1]; ++y) {
      kernels::sobel(executor.simd(), rows_around(image, dims, y, z).data(), width, scale,
                     scratch.data(), gx.data(), gy.data(), gz.data());
      use({static_cast<size_t>(z * dims[1] + y) * width, width, gx.data(), gy.data(), gz.data()});
    }
  });
}

}  // namespace plc
