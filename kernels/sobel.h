// The Sobel operator on rows of an image (paper, 3.8), and what is made of its vectors.
#pragma once
#include <array>
#include <cstddef>

#include "kernels/ring.h"
#include "kernels/simd.h"

// Bits depend neither on `simd` nor on where rows begin in memory.
namespace plc::kernels {

// Floats of scratch that sobel needs for rows of `width` values.
constexpr size_t sobel_scratch(size_t width) {
  return 3 * (width + 2);
}

// 1/2 of the central difference times 1/4 of either mean.
inline constexpr float kSobelNorm = 1.0F / 32.0F;

// How the scratch is used: per column of the nine rows, sums without the factors 1/2 and 1/4;
// column i of the image has place i + 1, the ends are repeated at both sides.
struct SobelColumns {
  float* mean;     // over y and z
  float* along_y;  // difference over y, mean over z
  float* along_z;  // difference over z, mean over y

  SobelColumns(float* scratch, size_t width)
      : mean(scratch), along_y(scratch + (width + 2)), along_z(scratch + 2 * (width + 2)) {}
  void repeat_ends(size_t width) const {
    for (float* sums : {mean, along_y, along_z}) {
      sums[0] = sums[1];
      sums[width + 1] = sums[width];
    }
  }
};

// The gradient at every voxel of a row, times `scale` per axis: along an axis the central
// difference [-1 0 1]/2, along the two others the mean [1 2 1]/4. rows[3 k + j] is row y - 1 + j of
// plane z - 1 + k, `width` >= 1 values; at a border of the image the caller repeats the border's
// row or plane, and the kernel repeats the row's ends. Outputs are rows of `width` values.
void sobel(SimdTarget simd, const float* const* rows, size_t width,
           const std::array<float, 3>& scale, float* scratch, float* gx, float* gy, float* gz);

// vectors[i] = (gx, gy, gz, 0)[i] / max(|g|, bound), i < count: lengths up to `bound` become
// lengths up to 1, longer ones 1 (both but for rounding). `bound` > 0; squares of the components
// and of `bound` must be normal floats where they matter.
void bound_vectors(SimdTarget simd, const float* gx, const float* gy, const float* gz, size_t count,
                   float bound, Float4* vectors);

// norms[i] = factor |g|, i < count.
void vector_norms(SimdTarget simd, const float* gx, const float* gy, const float* gz, size_t count,
                  float factor, float* norms);

}  // namespace plc::kernels
