// One axis of a convolution with any number of weights.
#pragma once
#include <cstddef>

#include "kernels/simd.h"

namespace plc::kernels {

// out[i] = sum over k = 0 .. taps-1, in this order, of weights[k] * rows[k][i], i = begin .. end-1,
// any range; each product and each addition rounded once, on every target. taps >= 1. `out` is none
// of the rows.
void weighted_rows(SimdTarget simd, const float* weights, size_t taps, const float* const* rows,
                   size_t begin, size_t end, float* out);

}  // namespace plc::kernels
