// Bilinear interpolation between four rows of values: of trilinear sampling, which goes along x,
// then y, then z, the last two thirds for places in a row.
#pragma once
#include <array>
#include <cstddef>

#include "kernels/simd.h"

namespace plc::kernels {

// out[i], i = begin .. end-1, lies at (y, z) in [0,1]^2 between rows[0][i] (0,0), rows[1][i] (1,0),
// rows[2][i] (0,1) and rows[3][i] (1,1): lerp(a, b, t) = a + (b - a) t along y, then z.
void blend_rows(SimdTarget simd, const std::array<const float*, 4>& rows, float y, float z,
                size_t begin, size_t end, float* out);

}  // namespace plc::kernels
