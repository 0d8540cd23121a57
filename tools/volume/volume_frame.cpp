#include "tools/volume/volume_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace plc::tools {

namespace {

// The patient axis that an axis of the image is nearest to.
size_t nearest_axis(const plc_image& image, size_t axis) {
  size_t nearest = 0;
  for (size_t k = 1; k < 3; ++k) {
    if (std::abs(image.direction[3 * k + axis]) > std::abs(image.direction[3 * nearest + axis])) {
      nearest = k;
    }
  }
  return nearest;
}

}  // namespace

Place lps_of(const plc_image& image, const Place& voxel) {
  Place place{};
  for (size_t k = 0; k < 3; ++k) {
    place[k] = image.origin[k];
    for (size_t axis = 0; axis < 3; ++axis) {
      place[k] += image.direction[3 * k + axis] * image.spacing[axis] * voxel[axis];
    }
  }
  return place;
}

Place voxel_of(const plc_image& image, const Place& lps) {
  const double* d = image.direction;
  Place r{};
  for (size_t k = 0; k < 3; ++k) r[k] = lps[k] - image.origin[k];
  // By the adjugate: the columns need not be perpendicular.
  const double determinant = d[0] * (d[4] * d[8] - d[5] * d[7]) -
                             d[1] * (d[3] * d[8] - d[5] * d[6]) +
                             d[2] * (d[3] * d[7] - d[4] * d[6]);
  const Place turned = {r[0] * (d[4] * d[8] - d[5] * d[7]) + r[1] * (d[2] * d[7] - d[1] * d[8]) +
                            r[2] * (d[1] * d[5] - d[2] * d[4]),
                        r[0] * (d[5] * d[6] - d[3] * d[8]) + r[1] * (d[0] * d[8] - d[2] * d[6]) +
                            r[2] * (d[2] * d[3] - d[0] * d[5]),
                        r[0] * (d[3] * d[7] - d[4] * d[6]) + r[1] * (d[1] * d[6] - d[0] * d[7]) +
                            r[2] * (d[0] * d[4] - d[1] * d[3])};
  Place voxel{};
  for (size_t k = 0; k < 3; ++k) voxel[k] = turned[k] / determinant / image.spacing[k];
  return voxel;
}

std::string axis_letters(const plc_image& image) {
  std::string letters;
  for (size_t axis = 0; axis < 3; ++axis) {
    const size_t k = nearest_axis(image, axis);
    letters += image.direction[3 * k + axis] < 0 ? "RAI"[k] : "LPS"[k];
  }
  return letters;
}

double obliquity(const plc_image& image) {
  double largest = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    double along = 0;
    double square = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double x = image.direction[3 * k + axis];
      square += x * x;
      if (k == nearest_axis(image, axis)) along = std::abs(x);
    }
    // Of small angles the arc cosine knows little.
    largest =
        std::max(largest, std::atan2(std::sqrt(std::max(0.0, square - along * along)), along));
  }
  return largest * 180 / std::numbers::pi;
}

Bounds bounds_of(const plc_image& image) {
  Bounds bounds{lps_of(image, {0, 0, 0}), lps_of(image, {0, 0, 0})};
  for (size_t corner = 1; corner < 8; ++corner) {
    Place voxel{};
    for (size_t axis = 0; axis < 3; ++axis) {
      if ((corner >> axis & 1) != 0) voxel[axis] = static_cast<double>(image.dims[axis] - 1);
    }
    const Place place = lps_of(image, voxel);
    for (size_t k = 0; k < 3; ++k) {
      bounds.low[k] = std::min(bounds.low[k], place[k]);
      bounds.high[k] = std::max(bounds.high[k], place[k]);
    }
  }
  return bounds;
}

}  // namespace plc::tools
