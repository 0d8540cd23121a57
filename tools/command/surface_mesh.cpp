#include "tools/command/surface_mesh.h"

#include "tools/command/engine_handles.h"
#include "tools/volume/mesh_spaces.h"

namespace plc::tools {

TriangleMesh mesh_of(plc_context* context, const plc_surface* surface, plc_space space) {
  TriangleMesh mesh;
  mesh.space = space_name(space);
  const int64_t vertices = plc_surface_vertex_count(surface);
  const int64_t faces = plc_surface_face_count(surface);
  mesh.xyz.resize(3 * static_cast<size_t>(vertices));
  demand(context, plc_surface_positions_f64(context, surface, space, mesh.xyz.data(), vertices));
  mesh.abc.resize(3 * static_cast<size_t>(faces));
  demand(context, plc_surface_faces(context, surface, space, mesh.abc.data(), faces));
  mesh.normals.resize(3 * static_cast<size_t>(vertices));
  demand(context, plc_surface_normals(context, surface, space, mesh.normals.data(), vertices));
  return mesh;
}

plc_measures measures_of(plc_context* context, const plc_surface* surface) {
  plc_measures measures{};
  measures.struct_size = sizeof measures;
  demand(context, plc_surface_measure(context, surface, PLC_SPACE_LPS, &measures));
  return measures;
}

}  // namespace plc::tools
