// From the voxels of an image in their own type to values in [0,1].
#pragma once
#include <cstddef>
#include <cstdint>

#include "kernels/simd.h"

namespace plc {

enum class VoxelType : uint8_t { kU8, kI16, kU16, kI32, kF32 };

// Bytes of one voxel.
constexpr size_t voxel_size(VoxelType type) {
  switch (type) {
    case VoxelType::kU8:
      return 1;
    case VoxelType::kI16:
    case VoxelType::kU16:
      return 2;
    case VoxelType::kI32:
    case VoxelType::kF32:
      return 4;
  }
  return 0;
}

}  // namespace plc

// Voxels [0, count) of `voxels`, which is aligned as its type; any count. Bits do not depend on
// `simd`.
namespace plc::kernels {

// values[i] = (voxel i - low) * scale in double, clipped to [0,1] (NaN gives 0), rounded to float.
void normalize_voxels(SimdTarget simd, VoxelType type, const void* voxels, size_t count, double low,
                      double scale, float* values);

struct VoxelExtent {
  double low = 0, high = 0;  // of the finite voxels; both 0 where there are none; never -0
  size_t not_finite = 0;     // NaN and infinite voxels
};
VoxelExtent voxel_extent(SimdTarget simd, VoxelType type, const void* voxels, size_t count);

}  // namespace plc::kernels
