// The labels of a label image: its distinct values that are not 0.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/pellicle.h"

namespace plc::tools {

constexpr size_t kMaxLabels = 65535;

struct Label {
  int32_t value;
  int64_t voxels;
  std::array<int64_t, 3> low, high;  // the box of voxels that holds it, both ends within
};

// In ascending order of their values. One pass over the voxels. Throws Failure, which names `path`,
// where a voxel is no integer of 32 bits or there are more than kMaxLabels.
std::vector<Label> find_labels(const std::string& path, const plc_image& image);

// One label cut out of its image.
struct LabelCrop {
  std::array<int64_t, 3> low;   // the first voxel's indices in the whole image; may be -1
  std::vector<uint8_t> voxels;  // 255 in the label, 0 elsewhere
  plc_image image{};            // of them, in its place in the frame of the whole image
};

// The label's box and one voxel around it, whether the image has that or not.
LabelCrop crop_label(const plc_image& image, const Label& label);

}  // namespace plc::tools
