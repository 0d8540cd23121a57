// Where the voxels of an image lie in patient space.
#pragma once
#include <array>
#include <string>

#include "engine/pellicle.h"

namespace plc::tools {

using Place = std::array<double, 3>;

// Of voxel indices, voxel centres at integers, in LPS (mm), and back.
Place lps_of(const plc_image& image, const Place& voxel);
Place voxel_of(const plc_image& image, const Place& lps);

// Where each axis of the image runs to, by the patient axis nearest to it: "LPS" where x runs to
// the left, y to the back (posterior) and z to the head (superior).
std::string axis_letters(const plc_image& image);
// The largest angle between an axis of the image and the patient axis nearest to it, degrees.
double obliquity(const plc_image& image);

// The box around the centres of all voxels, in LPS.
struct Bounds {
  Place low, high;
};
Bounds bounds_of(const plc_image& image);

}  // namespace plc::tools
