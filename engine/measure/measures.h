// Area, volume, components and genus of a triangle mesh.
#pragma once
#include <cstddef>
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "engine/measure/mesh_topology.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// A set of faces connected over edges.
struct ComponentMeasures {
  uint32_t component;  // as numbered by MeshTopology
  uint32_t first_face;
  int64_t faces;
  int64_t vertices;  // a vertex where the component touches itself counts again
  int64_t genus;     // -1 unless closed and consistently oriented
  double area;
  double volume;  // signed: > 0 when faces are outward; meaningless unless closed
};

// Of all components together.
struct SurfaceMeasures {
  int64_t vertices = 0, faces = 0, components = 0, euler = 0, genus = 0;
  double area = 0, volume = 0;
};

// At most kMaxFaces faces. Real is float or double; sums are of doubles, in an order that depends
// on the faces only: the same bits for any executor. The volume of each component is taken from a
// corner of it, so that a mesh far from the origin, or small beside others, loses no digits.
//
// All components, the largest area first, ties by number.
template <typename Real>
Vector<ComponentMeasures> component_measures(const MeshArraysOf<Real>& mesh,
                                             const MeshTopology& topology,
                                             const Executor& executor);
template <typename Real>
Vector<ComponentMeasures> component_measures(const MeshArraysOf<Real>& mesh,
                                             const Executor& executor);

// Of the whole: sums over the components in their order; genus -1 where one has none. vertices
// counts isolated ones too, euler does not. An empty mesh has zeros everywhere.
SurfaceMeasures total_measures(size_t vertex_count, const MeshTopology& topology,
                               const Vector<ComponentMeasures>& components);
template <typename Real>
SurfaceMeasures surface_measures(const MeshArraysOf<Real>& mesh, const Executor& executor);

}  // namespace plc
