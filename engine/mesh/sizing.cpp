#include "engine/mesh/sizing.h"

#include "kernels/image_force.h"

namespace plc {

bool Sizing::inside(Vec3 p) const {
  const Float4 at{p.x, p.y, p.z, 0};
  float value = 0;
  kernels::sample_trilinear(SimdTarget::kScalar, object.image, &at, 0, 1, &value);
  return object.has(value);
}

}  // namespace plc
