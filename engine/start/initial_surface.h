// Initial surfaces (3.6): one bubble around the object, or a grid of bubbles.
#pragma once
#include <array>

#include "engine/base/vec3.h"
#include "engine/mesh/mesh.h"
#include "pyramid/executor.h"
#include "pyramid/status.h"

namespace plc {

// A box of mesh space.
struct Extent {
  std::array<double, 3> low{}, high{};

  std::array<double, 3> middle() const {
    return {(high[0] + low[0]) / 2, (high[1] + low[1]) / 2, (high[2] + low[2]) / 2};
  }
};

// The half axes of the bubble around a box; its middle is the box's.
std::array<double, 3> bubble_half(const Extent& box, double delta);

// One closed surface around the box, with edges of 1.2 to 2.7 times delta in the mean, none as long
// as 3.46 (embedding_guard.h); the first iteration splits what violates (2). An icosahedron refined
// by (3.4) onto |x/a|^4 + |y/b|^4 + |z/c|^4 = 1, which circumscribes the box and wastes less room
// than the ellipsoid does. mesh.delta = delta.
//
// kOutOfMemory, here and below: more vertices than a mesh can have, told before memory is taken.
Status make_bubble(Mesh& mesh, const Extent& box, double delta, const Executor& executor);

// Adds an ellipsoid with edges of 1 to 2 delta to the mesh, which keeps its delta. The caller sees
// to it that it is apart from the rest by (3).
Status append_bubble(Mesh& mesh, Vec3 centre, Vec3 radii, const Executor& executor);

// counts[0] x counts[1] x counts[2] spheres over the box, apart from each other by (3).
// kInvalidArgument when they would be too small for delta.
Status make_bubbles(Mesh& mesh, const Extent& box, const std::array<int, 3>& counts, double delta,
                    const Executor& executor);

}  // namespace plc
