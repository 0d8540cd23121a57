// What guides the surface on one level: the images that pull it, and what the user adds.
#pragma once
#include "engine/motion/user_constraints.h"
#include "kernels/image.h"
#include "kernels/ring.h"

namespace plc {

struct Guide {
  ImageView image;                        // Pi_I of (7); not read where attraction is 0
  float iso = 0;                          // pi_I
  GradientView gradient;                  // Pi_gradI of (8); data is null where it is not used
  Metric metric;                          // of the forces, against the mesh's own lengths (4.4)
  const UserConstraints* user = nullptr;  // borrowed
};

}  // namespace plc
