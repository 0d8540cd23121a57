#include "engine/start/thickness.h"

namespace plc {

bool is_thin(const ImageObject& object, const Voxel& at, float least) {
  const auto of_object = [&](const Voxel& v) {
    return object.has(image_value(object.image, v[0], v[1], v[2]));
  };
  const bool own = of_object(at);
  for (size_t axis = 0; axis < 3; ++axis) {
    const float extent =
        extent_along(object, at, axis, least, [&](const Voxel& v) { return of_object(v) == own; });
    if (extent < least) return true;
  }
  return false;
}

}  // namespace plc
