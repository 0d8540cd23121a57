// The image as the page has it: 8 bits per voxel, and no more voxels than a browser takes easily.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/pellicle.h"

namespace plc::tools {

// Values of the image that become 0 and 255.
struct GreyWindow {
  double low = 0;
  double high = 255;

  double step() const { return (high - low) / 255; }  // in units of the image
};

struct GreyImage {
  std::array<int64_t, 3> dims{};
  // How many voxels of the image one of these is the mean of, along each axis; at the far border it
  // is of those that are left.
  std::array<int64_t, 3> reduction = {1, 1, 1};
  GreyWindow window;
  bool exact = false;           // greys tell the image's values apart, all of them
  double low = 0, high = 0;     // the smallest and the largest finite value of the image
  std::vector<uint8_t> voxels;  // x fastest; what is not finite is 0

  bool reduced() const { return reduction != std::array<int64_t, 3>{1, 1, 1}; }
};

// Reduced until it has at most max_voxels, along the axis whose voxels are then the shortest.
// Without a window it is the image's range where that is at most 255 and values are integers, so
// that all are kept; else from the 0.01th to the 99.99th percentile. The image must have x fastest
// and no gaps, as readers make it.
GreyImage grey_image(const plc_image& image, const std::optional<GreyWindow>& window,
                     int64_t max_voxels);

}  // namespace plc::tools
