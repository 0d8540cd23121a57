#include "engine/measure/measures.h"

#include <algorithm>

#include "engine/base/blocks.h"
#include "engine/base/double3.h"
#include "pyramid/buffer.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kFaceBlock = 4096;

struct FaceMeasures {
  double twice_area;
  double six_volume;  // of the tetrahedron with the component's own corner
};

}  // namespace

template <typename Real>
Vector<ComponentMeasures> component_measures(const MeshArraysOf<Real>& mesh,
                                             const MeshTopology& topology,
                                             const Executor& executor) {
  const size_t face_count = topology.component.size();
  Buffer<FaceMeasures> faces;
  faces.resize_uninitialized(face_count);
  run_blocks(executor, face_count, kFaceBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t f = begin; f < end; ++f) {
      const size_t first = topology.components[topology.component[f]].first_face;
      const Real *a = mesh.corner(3 * f), *b = mesh.corner(3 * f + 1), *c = mesh.corner(3 * f + 2);
      const Double3 normal = cross(difference(b, a), difference(c, a));
      faces[f] = {length(normal), dot(normal, difference(a, mesh.corner(3 * first)))};
    }
  });
  Vector<ComponentMeasures> measures;
  measures.reserve(topology.components.size());
  for (const ComponentTopology& t : topology.components) {
    const auto index = static_cast<uint32_t>(measures.size());
    measures.push_back({index, t.first_face, t.faces, t.vertices, t.genus(), 0, 0});
  }
  for (size_t f = 0; f < face_count; ++f) {
    ComponentMeasures& component = measures[topology.component[f]];
    component.area += faces[f].twice_area;
    component.volume += faces[f].six_volume;
  }
  for (ComponentMeasures& component : measures) {
    component.area /= 2;
    component.volume /= 6;
  }
  std::sort(measures.begin(), measures.end(),
            [](const ComponentMeasures& a, const ComponentMeasures& b) {
              return a.area != b.area ? a.area > b.area : a.component < b.component;
            });
  return measures;
}

template <typename Real>
Vector<ComponentMeasures> component_measures(const MeshArraysOf<Real>& mesh,
                                             const Executor& executor) {
  return component_measures(
      mesh, mesh_topology(mesh.abc, mesh.face_count, mesh.vertex_count, executor), executor);
}

SurfaceMeasures total_measures(size_t vertex_count, const MeshTopology& topology,
                               const Vector<ComponentMeasures>& components) {
  SurfaceMeasures m;
  m.vertices = static_cast<int64_t>(vertex_count);
  m.faces = static_cast<int64_t>(topology.component.size());
  m.components = static_cast<int64_t>(components.size());
  m.euler = topology.euler;
  for (const ComponentMeasures& component : components) {
    m.area += component.area;
    m.volume += component.volume;
    m.genus = m.genus < 0 || component.genus < 0 ? -1 : m.genus + component.genus;
  }
  return m;
}

template <typename Real>
SurfaceMeasures surface_measures(const MeshArraysOf<Real>& mesh, const Executor& executor) {
  const MeshTopology topology =
      mesh_topology(mesh.abc, mesh.face_count, mesh.vertex_count, executor);
  return total_measures(mesh.vertex_count, topology, component_measures(mesh, topology, executor));
}

#define PLC_INSTANTIATE(Real)                                                                  \
  template Vector<ComponentMeasures> component_measures(const MeshArraysOf<Real>&,             \
                                                        const MeshTopology&, const Executor&); \
  template Vector<ComponentMeasures> component_measures(const MeshArraysOf<Real>&,             \
                                                        const Executor&);                      \
  template SurfaceMeasures surface_measures(const MeshArraysOf<Real>&, const Executor&);
PLC_INSTANTIATE(float)
PLC_INSTANTIATE(double)
#undef PLC_INSTANTIATE

}  // namespace plc
