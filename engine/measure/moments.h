// Centroid, second moments, principal axes and box of each component of a mesh and of the whole.
//
// All moments are of the enclosed volume with density 1, by the divergence theorem: signed sums of
// tetrahedra from a corner of the component to its faces, so that a component far from the origin,
// or small beside others, loses no digits. They have the sign of the volume: a cavity, whose wall
// faces inward, is subtracted where components are summed.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/pellicle.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

struct ShapeMeasures {
  plc_component_measures whole;
  Vector<plc_component_measures> components;  // the largest area first, ties by first_face
};

// xyz: three finite values per vertex; abc: three indices below vertex_count per face; at most
// kMaxFaces faces. The same bits for any executor. plc_component_measures says what the fields are.
ShapeMeasures shape_measures(const double* xyz, size_t vertex_count, const uint32_t* abc,
                             size_t face_count, const Executor& executor);

}  // namespace plc
