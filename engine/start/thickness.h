// How thick what a voxel is of is, by the image: the object, or the gap between its parts.
#pragma once
#include <cmath>

#include "engine/start/voxel_set.h"
#include "kernels/image_value.h"
#include "pyramid/image_object.h"

namespace plc {

// How far the iso-surface is apart on the two sides of a voxel along an axis, in mesh units; as
// soon as that is `enough`, no more is looked at. goes_on(voxel) tells which voxels next to it on
// the axis are of the same part. Reads the image within its border alone; an image ends half a
// voxel from its last.
template <typename GoesOn>
float extent_along(const ImageObject& object, const Voxel& at, size_t axis, float enough,
                   const GoesOn& goes_on) {
  const ImageView& image = object.image;
  const float step = 1 / image.scale[axis];
  const auto within = [&](const Voxel& v) { return v[axis] >= 0 && v[axis] < image.dims[axis]; };
  const auto depth = [&](const Voxel& v) {
    return std::abs(image_value(image, v[0], v[1], v[2]) - object.iso);
  };
  float extent = 0;
  for (const int32_t way : {-1, 1}) {
    Voxel last = at, next = at;
    for (next[axis] += way; extent < enough && within(next) && goes_on(next); next[axis] += way) {
      extent += step;
      last = next;
    }
    if (extent >= enough) break;
    // How much of the way from a voxel to the next, which is on the other side, is of it.
    const float inside = depth(last);
    const float part = !within(next) ? 0.5F : inside == 0 ? 0 : inside / (inside + depth(next));
    extent += step * part;
  }
  return extent;
}

// Whether it is less than that along some axis.
bool is_thin(const ImageObject& object, const Voxel& at, float least);

}  // namespace plc
