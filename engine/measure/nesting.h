// Which components of a closed surface are walls of cavities, and which face the wrong way.
#pragma once
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "engine/exact/face_tree.h"
#include "engine/measure/measures.h"
#include "engine/measure/mesh_topology.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

struct ComponentSide {
  bool nested;  // inside an odd number of other components: a wall of a cavity
  bool wrong;   // its volume is not > 0, or, for a nested one, not < 0
};

// Of each component, by number. The mesh must be closed and consistently oriented; the tree holds
// its faces that are not of zero area. Depth is the parity of crossings of a ray from the centre of
// the component's largest face with all other components, by exact predicates. A ray that touches
// no vertex or edge decides alone; should all three fail in this, the majority does. Where
// components intersect each other depth means little: such a mesh is invalid anyway.
Vector<ComponentSide> component_sides(const MeshArrays& mesh, const MeshTopology& topology,
                                      const Vector<ComponentMeasures>& measures,
                                      const FaceTree& tree, const Executor& executor);

}  // namespace plc
