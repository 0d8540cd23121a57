// One image of the pyramid, and its gradient, as the sampling kernels read them.
#pragma once
#include <cstdint>

#include "kernels/bricks.h"
#include "kernels/ring.h"
#include "kernels/voxels.h"

namespace plc {

// A voxel whose value lies in [0,1] as it is: those of the levels above I_0, and of an I_0
// whose window floats do not hold.
struct UnitVoxel {
  float value;
};

// What an image's voxels are in memory: UnitVoxel, or the caller's own, uint8_t .. float.
enum class ImageType : uint8_t { kUnit, kU8, kI16, kU16, kF32 };

// How stored voxels become an image: I_0 is the caller's volume, read where it lies; of 32-bit
// integers a copy in floats.
struct VoxelForm {
  ImageType type = ImageType::kUnit;
  int32_t pad = 0;      // voxels on every side that the image has and the memory has not; kUnit: 0
  float pad_value = 0;  // their value, in [0,1]
  // The value of a stored voxel v: (float(v) - low) * scale, clipped to [-beyond, 1 + beyond], NaN
  // is the least. In floats, each operation rounded once: the same bits whoever reads the voxel.
  // Not used by kUnit.
  float low = 0, scale = 1, beyond = 0;
};

// Values in [0,1], or `beyond` farther out, x fastest. A point p of mesh space lies at voxel
// coordinate scale * p + offset on each axis (voxel centres at integers), clamped to the image:
// outside, the border voxels are replicated (paper, 4.2). No coordinate makes a kernel read outside
// the image: a NaN counts as the image's lower border.
struct ImageView {
  const void* data = nullptr;  // dims - 2 pad voxels of form.type, borrowed
  // With the padding, each >= 2. The product is below 2^31 where the voxels are UnitVoxels; else
  // the products of two are, and that of all is below 2^40.
  int32_t dims[3] = {0, 0, 0};
  float scale[3] = {1, 1, 1};
  float offset[3] = {0, 0, 0};
  VoxelForm form{};
  const Bricks* bricks =
      nullptr;  // where the voxels are, of another type than kUnit, if data is null
};

// body(voxel): once, with a value of the type that the voxels of `type` have. The choice is made
// here, outside of loops; what the body then calls is a template of the voxel's type.
template <class Body>
inline void with_voxel_type(ImageType type, const Body& body) {
  switch (type) {
    case ImageType::kUnit:
      return body(UnitVoxel{});
    case ImageType::kU8:
      return body(uint8_t{});
    case ImageType::kI16:
      return body(int16_t{});
    case ImageType::kU16:
      return body(uint16_t{});
    case ImageType::kF32:
      return body(float{});
  }
}

// A vector per voxel, by the same rules of place; w is not read.
struct GradientView {
  const Float4* data = nullptr;
  int32_t dims[3] = {0, 0, 0};  // each >= 2; the product is below 2^31
  float scale[3] = {1, 1, 1};
  float offset[3] = {0, 0, 0};
};

}  // namespace plc
