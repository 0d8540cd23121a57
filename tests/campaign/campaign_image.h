// The image of a case: a phantom in some voxel type, frame and window.
#pragma once
#include <cstddef>
#include <vector>

#include "pyramid/volume.h"
#include "tests/campaign/campaign_case.h"

namespace campaign {

// Phantom, image, voxels and inside_below.
void choose_image(Case& c);
// What depends on the image's values: feature and force, iso, window, pad_value, level_iso. Before
// it: the image and the levels.
void choose_values(Case& c);

// The values in the given type, `scale` and `offset` applied, rounded and clipped.
std::vector<std::byte> stored(const std::vector<float>& values, plc_voxel_type type, double scale,
                              double offset);

plc::VolumeView view_of(const plc_image& image);

}  // namespace campaign
