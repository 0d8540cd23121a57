// Where the voxels of an image lie in patient space.
#pragma once
#include <array>

#include "engine/pellicle.h"

namespace plc::tools {

using Point = std::array<double, 3>;

// lps = matrix * voxel + origin; rows of the matrix are those of LPS.
struct ImageFrame {
  std::array<double, 9> matrix{};
  Point origin{};

  Point to_lps(const Point& voxel) const;
  Point to_voxel(const Point& lps) const;
};

ImageFrame frame_of(const plc_image& image);

// The middle of the image, in LPS.
Point middle_of(const plc_image& image);

}  // namespace plc::tools
