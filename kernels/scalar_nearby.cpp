// Scalar twin of kernels/nearby.h.
#include "kernels/scalar.h"

namespace plc::kernels::scalar {

uint32_t near_or_turned(const NearbyView& view, const NearbyQuery& q, uint32_t* hits) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < view.count; ++i) {
    const float x = view.x[i] - q.x, y = view.y[i] - q.y, z = view.z[i] - q.z;
    const float squared = x * x + y * y + z * z;
    const float agreement = view.nx[i] * q.nx + view.ny[i] * q.ny + view.nz[i] * q.nz;
    if (squared <= q.far_squared && (agreement <= q.most || squared < q.near_squared)) {
      hits[count++] = i;
    }
  }
  return count;
}

}  // namespace plc::kernels::scalar
