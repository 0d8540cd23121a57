// Levels of pyramids as plain floats, whatever their voxels are.
#pragma once
#include <vector>

#include "kernels/image_value.h"
#include "pyramid/pyramid.h"

namespace samples {

inline std::vector<float> values_of(const plc::ImageView& image) {
  const auto width = static_cast<size_t>(image.dims[0]);
  const auto rows = static_cast<size_t>(image.dims[1]);
  std::vector<float> values(width * rows * static_cast<size_t>(image.dims[2]));
  for (size_t row = 0; row * width < values.size(); ++row) {
    plc::image_row(image, static_cast<int64_t>(row % rows), static_cast<int64_t>(row / rows),
                   values.data() + row * width);
  }
  return values;
}
inline std::vector<float> values_of(const plc::PyramidLevel& level) {
  return values_of(plc::level_image(level));
}

}  // namespace samples
