#include "tools/view/frame.h"

#include <cstddef>

namespace plc::tools {

Point ImageFrame::to_lps(const Point& voxel) const {
  Point lps = origin;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t axis = 0; axis < 3; ++axis) lps[row] += matrix[3 * row + axis] * voxel[axis];
  }
  return lps;
}

// By Cramer's rule. Readers refuse axes that do not span space.
Point ImageFrame::to_voxel(const Point& lps) const {
  const std::array<double, 9>& m = matrix;
  const Point d = {lps[0] - origin[0], lps[1] - origin[1], lps[2] - origin[2]};
  const Point c0 = {m[4] * m[8] - m[5] * m[7], m[5] * m[6] - m[3] * m[8],
                    m[3] * m[7] - m[4] * m[6]};
  const Point c1 = {m[2] * m[7] - m[1] * m[8], m[0] * m[8] - m[2] * m[6],
                    m[1] * m[6] - m[0] * m[7]};
  const Point c2 = {m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5],
                    m[0] * m[4] - m[1] * m[3]};
  const double determinant = m[0] * c0[0] + m[1] * c0[1] + m[2] * c0[2];
  Point voxel;
  for (size_t axis = 0; axis < 3; ++axis) {
    voxel[axis] = (c0[axis] * d[0] + c1[axis] * d[1] + c2[axis] * d[2]) / determinant;
  }
  return voxel;
}

ImageFrame frame_of(const plc_image& image) {
  ImageFrame frame;
  for (size_t row = 0; row < 3; ++row) {
    frame.origin[row] = image.origin[row];
    for (size_t axis = 0; axis < 3; ++axis) {
      frame.matrix[3 * row + axis] = image.direction[3 * row + axis] * image.spacing[axis];
    }
  }
  return frame;
}

Point middle_of(const plc_image& image) {
  Point voxel;
  for (size_t axis = 0; axis < 3; ++axis) {
    voxel[axis] = static_cast<double>(image.dims[axis] - 1) / 2;
  }
  return frame_of(image).to_lps(voxel);
}

}  // namespace plc::tools
