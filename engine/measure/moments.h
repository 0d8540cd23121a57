// Centroid, second moments, principal axes and box of each component of a mesh and of the whole.
//
// All moments are of the enclosed volume with density 1, by the divergence theorem: signed sums of
// tetrahedra from a corner of the component to its faces, so that a component far from the origin,
// or small beside others, loses no digits. They have the sign of the volume: a cavity, whose wall
// faces inward, is subtracted where components are summed.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// The fields are those of plc_component_measures.
struct ComponentShape {
  int64_t first_face = 0, vertices = 0, faces = 0, euler = 0, genus = 0;
  double area = 0, volume = 0;
  double low[3] = {0, 0, 0}, high[3] = {0, 0, 0};
  double centroid[3] = {0, 0, 0};
  double moments[6] = {0, 0, 0, 0, 0, 0};
  double principal_moments[3] = {0, 0, 0};
  double principal_axes[9] = {0, 0, 0, 0, 0, 0, 0, 0, 0};
};

struct ShapeMeasures {
  ComponentShape whole;
  Vector<ComponentShape> components;  // the largest area first, ties by first_face
};

// At most kMaxFaces faces. The same bits for any executor.
ShapeMeasures shape_measures(const MeshArrays& mesh, const Executor& executor);

}  // namespace plc
