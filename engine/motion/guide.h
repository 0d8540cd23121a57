// What guides the surface on one level: the images that pull it, and what the user adds.
#pragma once
#include "engine/base/vec3.h"
#include "engine/motion/user_constraints.h"
#include "kernels/image.h"
#include "kernels/ring.h"

namespace plc {

// Where the vertices of a patch may be (mesh.h).
struct Room {
  Vec3 low, high;
  bool contains(Vec3 p) const {
    return p.x >= low.x && p.x <= high.x && p.y >= low.y && p.y <= high.y && p.z >= low.z &&
           p.z <= high.z;
  }
};

struct Guide {
  ImageView image;                        // Pi_I of (7); not read where attraction is 0
  float iso = 0;                          // pi_I
  GradientView gradient;                  // Pi_gradI of (8); data is null where it is not used
  Metric metric;                          // of the forces, against the mesh's own lengths (4.4)
  const UserConstraints* user = nullptr;  // borrowed
  Room room;                              // read of patches alone
};

}  // namespace plc
