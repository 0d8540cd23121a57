// Rows of an image as floats, whatever its voxels are: what every pass over a level reads.
#pragma once
#include <cstdint>

#include "kernels/image.h"
#include "kernels/simd.h"

namespace plc::kernels {

// values = rows first .. end-1 of plane z of the image, dims[0] values each, one after the other,
// with the padding. 0 <= first <= end <= dims[1], 0 <= z < dims[2]. The bits of image_value().
void image_rows(SimdTarget simd, const ImageView& image, int64_t z, int64_t first, int64_t end,
                float* values);

}  // namespace plc::kernels
