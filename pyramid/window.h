// The grey-level window derived from the image: what is mapped to 0 and 1 around the iso-value.
#pragma once
#include <cstdint>

#include "pyramid/base_image.h"
#include "pyramid/executor.h"
#include "pyramid/pyramid.h"
#include "pyramid/volume.h"

namespace plc {

struct DerivedWindow : Window {
  double background = 0;    // typical value across the surface from the object
  uint64_t at_surface = 0;  // voxels of the object that have one outside it for a face neighbour
};

// Typical values on either side of the iso-surface are the medians of the voxels of the object that
// have a voxel outside it for a face neighbour, and of the latter. The window reaches beyond the
// iso-value by several times as much as they do, and not beyond the image's range, so that what is
// far from the surface neither weakens (7) there nor hides thin parts of the object in the coarse
// images. `range` is that of the image. The same for any executor.
DerivedWindow derive_window(const VolumeView& volume, const VoxelRange& range, double iso,
                            bool inside_above, const Executor& executor);

}  // namespace plc
