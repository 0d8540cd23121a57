// A level of the pyramid that is too large to be kept: its bricks are reduced from the level below
// as they are read.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "kernels/image.h"
#include "pyramid/brick_cache.h"
#include "pyramid/taps.h"

namespace plc {

// Voxels are floats in [0,1]: the same as those that reduce_image() writes.
class ReducedBricks final : public CachedBricks {
 public:
  // from: the level below, of bricks, which `below` keeps. taps: to `dims` voxels.
  ReducedBricks(const ImageView& from, std::shared_ptr<const CachedBricks> below,
                std::array<AxisTaps, 3> taps, const std::array<int64_t, 3>& dims, SimdTarget simd);
  ~ReducedBricks() override;

  // As close_border() of pyramid/border.h. Nobody may be reading.
  void close_border(double iso, double outside);

 private:
  struct Border {
    double iso, outside;
  };
  void fill(const std::array<int64_t, 3>& at, void* voxels) const override;
  void close(const std::array<int64_t, 3>& first, const std::array<int64_t, 3>& size,
             float* values) const;

  ImageView from_;
  std::shared_ptr<const CachedBricks> below_;
  std::array<AxisTaps, 3> taps_;
  SimdTarget simd_;
  std::optional<Border> border_;
};

}  // namespace plc
