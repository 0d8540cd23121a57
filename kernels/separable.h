// One axis at a time of the pyramid's kernel (paper, 4.2, eq. (12); appendix A).
#pragma once
#include <cstddef>
#include <cstdint>

#include "kernels/simd.h"

// Every output is the sum over k = 0 .. taps-1, in this order, of weight k times input first + k,
// each product and each addition rounded once. Bits do not depend on `simd` nor on how the outputs
// are divided between calls.
namespace plc::kernels {

inline constexpr int32_t kMaxTaps = 6;  // 5 points at most one voxel apart, linear in between

// Output i of an axis reads inputs first[i] .. first[i] + taps - 1, all inside the image, with
// weights[i * taps ..].
struct TapsView {
  const int32_t* first = nullptr;
  const float* weights = nullptr;
  int32_t taps = 0;  // 1 .. kMaxTaps
};

// Rows of `width` values, `stride` floats apart.
struct ConstRows {
  const float* values;
  size_t width, stride;
};
struct Rows {
  float* values;
  size_t width, stride;
};

// Floats of scratch that reduce_x needs for rows of `width` values.
constexpr size_t reduce_x_scratch(size_t width) {
  return width * 16;
}

// Along X: row r of `out` from row r of `in`, r < rows. `scratch` is 64-byte aligned.
void reduce_x(SimdTarget simd, const TapsView& taps, const ConstRows& in, size_t rows,
              const Rows& out, float* scratch);

// Along Y: output rows begin .. end-1 from whole rows of the same width. `in` starts at input row
// first[begin], `out` at output row begin.
void reduce_y(SimdTarget simd, const TapsView& taps, size_t begin, size_t end, const ConstRows& in,
              const Rows& out);

// Along Z, the last axis: out[i] = sum of weights[k] * planes[k][i], i < count, limited to 1 (the
// rounded weights may add up to a little more).
void reduce_z(SimdTarget simd, const float* weights, int32_t taps, const float* const* planes,
              size_t count, float* out);

}  // namespace plc::kernels
