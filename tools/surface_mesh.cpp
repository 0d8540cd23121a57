#include "tools/surface_mesh.h"

#include "tools/engine_handles.h"

namespace plc::tools {

TriangleMesh mesh_of(const plc_surface* surface, plc_space space) {
  TriangleMesh mesh;
  const auto vertices = static_cast<size_t>(plc_surface_vertex_count(surface));
  std::vector<float> xyz(3 * vertices);
  plc_surface_positions(surface, space, xyz.data());
  mesh.xyz.assign(xyz.begin(), xyz.end());
  mesh.abc.resize(3 * static_cast<size_t>(plc_surface_face_count(surface)));
  plc_surface_faces(surface, space, mesh.abc.data());
  mesh.normals.resize(3 * vertices);
  plc_surface_normals(surface, space, mesh.normals.data());
  return mesh;
}

plc_measures measures_of(plc_context* context, const plc_surface* surface) {
  plc_measures measures{};
  measures.struct_size = sizeof measures;
  const plc_status status = plc_surface_measure(context, surface, PLC_SPACE_LPS, &measures);
  if (status != PLC_OK) throw failure_of(context, status);
  return measures;
}

}  // namespace plc::tools
