// What of an image is the object.
#pragma once
#include "kernels/image.h"

namespace plc {

// The voxels of a value >= iso (above) or <= iso; a NaN is not of it.
struct ImageObject {
  ImageView image;
  float iso;
  bool above;

  bool has(float value) const { return above ? value >= iso : value <= iso; }
};

}  // namespace plc
