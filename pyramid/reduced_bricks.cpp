#include "pyramid/reduced_bricks.h"

#include <algorithm>
#include <new>
#include <utility>

#include "kernels/image_value.h"
#include "pyramid/border.h"
#include "pyramid/buffer.h"
#include "pyramid/reduction.h"

namespace plc {

namespace {

// Of a brick, on every axis: 128 KiB of floats. At the reduction of sqrt 3 twice as many voxels of
// the level below are read as with bricks of any size.
constexpr int64_t kSide = 32;

// Of the outputs first .. end - 1, their inputs counted from the first one that they read.
AxisTaps part_of(const AxisTaps& taps, int64_t first, int64_t end) {
  AxisTaps part;
  part.taps = taps.taps;
  part.first.assign(taps.first.begin() + first, taps.first.begin() + end);
  part.weights.assign(taps.weights.begin() + first * taps.taps,
                      taps.weights.begin() + end * taps.taps);
  for (int32_t& input : part.first) input -= taps.first[static_cast<size_t>(first)];
  return part;
}

}  // namespace

ReducedBricks::ReducedBricks(const ImageView& from, std::shared_ptr<const CachedBricks> below,
                             std::array<AxisTaps, 3> taps, const std::array<int64_t, 3>& dims,
                             SimdTarget simd)
    : CachedBricks(below->cache(), VoxelType::kF32, dims, {kSide, kSide, kSide}),
      from_(from),
      below_(std::move(below)),
      taps_(std::move(taps)),
      simd_(simd) {}

ReducedBricks::~ReducedBricks() = default;

void ReducedBricks::close_border(double iso, double outside) {
  border_ = Border{iso, outside};
  forget();
}

void ReducedBricks::fill(const std::array<int64_t, 3>& at, void* voxels) const {
  std::array<AxisTaps, 3> taps;
  std::array<int64_t, 3> first{}, size{}, low{}, inputs{};
  for (size_t a = 0; a < 3; ++a) {
    first[a] = at[a] * kSide;
    size[a] = std::min(kSide, dims_[a] - first[a]);
    taps[a] = part_of(taps_[a], first[a], first[a] + size[a]);
    low[a] = taps_[a].first[static_cast<size_t>(first[a])];
    inputs[a] = taps[a].first.back() + taps[a].taps;
  }
  Buffer<float> box, reduced;
  box.resize_uninitialized(static_cast<size_t>(inputs[0] * inputs[1] * inputs[2]));
  reduced.resize_uninitialized(static_cast<size_t>(size[0] * size[1] * size[2]));
  float* to = box.data();
  for (int64_t z = low[2]; z < low[2] + inputs[2]; ++z) {
    for (int64_t y = low[1]; y < low[1] + inputs[1]; ++y, to += inputs[0]) {
      image_row(from_, y, z, low[0], low[0] + inputs[0], to);
    }
  }
  ImageView image;
  image.data = box.data();
  for (size_t a = 0; a < 3; ++a) image.dims[a] = static_cast<int32_t>(inputs[a]);
  if (!reduce_image(image, taps, size, SerialExecutor(simd_), reduced.data())) {
    throw std::bad_alloc();
  }
  if (border_) close(first, size, reduced.data());
  const float* row = reduced.data();
  for (int64_t z = 0; z < size[2]; ++z) {
    for (int64_t y = 0; y < size[1]; ++y, row += size[0]) {
      std::copy_n(row, size[0], static_cast<float*>(voxels) + (z * kSide + y) * kSide);
    }
  }
}

// The voxels of the brick that lie on the border of the level.
void ReducedBricks::close(const std::array<int64_t, 3>& first, const std::array<int64_t, 3>& size,
                          float* values) const {
  const ClosedBorder closed(border_->iso, border_->outside);
  for (int64_t z = 0; z < size[2]; ++z) {
    for (int64_t y = 0; y < size[1]; ++y) {
      for (int64_t x = 0; x < size[0]; ++x, ++values) {
        const std::array<int64_t, 3> voxel{first[0] + x, first[1] + y, first[2] + z};
        bool border = false;
        for (size_t a = 0; a < 3; ++a) {
          border = border || voxel[a] == 0 || voxel[a] + 1 == dims_[a];
        }
        if (border) *values = closed(*values);
      }
    }
  }
}

}  // namespace plc
