// The C API: checks of any mesh, and surfaces made of one.
#include "engine/api/api_check.h"

#include <algorithm>

#include "engine/api/api_extras.h"
#include "engine/api/handles.h"
#include "engine/base/mesh_arrays.h"
#include "engine/measure/mesh_input.h"
#include "engine/start/mesh_import.h"

using plc::Status;

namespace plc {

plc_measures record_of(const SurfaceMeasures& m) {
  return {
      sizeof(plc_measures), m.vertices, m.faces, m.components, m.euler, m.genus, m.area, m.volume};
}

plc_check record_of(const MeshCheck& c) {
  plc_check out{};
  out.struct_size = sizeof out;
  out.measures = record_of(c.measures);
  out.valid = c.valid;
  out.closed = c.closed;
  out.manifold = c.manifold;
  out.oriented = c.oriented;
  out.outward = c.outward;
  out.border_edges = c.border_edges;
  out.non_manifold_edges = c.non_manifold_edges;
  out.non_manifold_vertices = c.non_manifold_vertices;
  out.inconsistent_edges = c.inconsistent_edges;
  out.wrongly_oriented_components = c.wrongly_oriented_components;
  out.degenerate_faces = c.degenerate_faces;
  out.duplicate_points = c.duplicate_points;
  out.isolated_vertices = c.isolated_vertices;
  out.self_intersections = c.self_intersections;
  std::copy(c.first_intersection, c.first_intersection + 2, out.first_intersection);
  out.edge_min = c.edge_min;
  out.edge_mean = c.edge_mean;
  out.edge_max = c.edge_max;
  out.min_angle = c.min_angle;
  out.max_angle = c.max_angle;
  out.valence_min = c.valence_min;
  out.valence_max = c.valence_max;
  return out;
}

}  // namespace plc

extern "C" {

plc_status plc_check_mesh(plc_context* context, const double* xyz, int64_t vertex_count,
                          const uint32_t* abc, int64_t face_count, plc_check* check) {
  return plc::guarded(context, [&]() -> Status {
    if (Status s = plc::check_output(check, "check"); !s.ok()) return s;
    plc::MeshCheck found;
    Status s = plc::check_mesh(plc::mesh_arrays(xyz, vertex_count, abc, face_count),
                               context->host->schedule, found);
    if (s.ok()) plc::give_struct(plc::record_of(found), check);
    return s;
  });
}

plc_status plc_surface_create(plc_context* context, plc_space space, const plc_image* image,
                              const double* xyz, int64_t vertex_count, const uint32_t* abc,
                              int64_t face_count, plc_surface** surface) {
  if (surface != nullptr) *surface = nullptr;
  return plc::guarded(context, [&]() -> Status {
    if (surface == nullptr) return plc::bad_argument("surface: must not be NULL");
    if (space < PLC_SPACE_LPS || space > PLC_SPACE_VOXEL) {
      return plc::bad_argument("space: not a plc_space");
    }
    plc_image where;
    plc_image_defaults(&where);
    if (image != nullptr) {
      if (Status s = plc::take_struct(image, plc_image_defaults, "image", where); !s.ok()) return s;
      if (Status s = plc::check_frame(where); !s.ok()) return s;
    }
    const plc::Host& host = *context->host;
    const plc::MeshArrays given = plc::mesh_arrays(xyz, vertex_count, abc, face_count);
    if (Status s = plc::check_mesh_input(given, host.schedule); !s.ok()) return s;
    auto made = std::make_unique<plc_surface>();
    made->host = context->host;
    made->frame = plc::frame_of(where);
    plc_parameters_defaults(&made->parameters);
    made->seconds.struct_size = sizeof made->seconds;
    const plc::VoxelMesh mesh = plc::in_voxels(made->frame.to(space), given);
    const plc::MeshArrays in_voxels{mesh.xyz.data(), given.vertex_count, mesh.abc.data(),
                                    given.face_count};
    if (Status s = plc::import_mesh(in_voxels, host.schedule, made->mesh, xyz); !s.ok()) return s;
    *surface = made.release();
    return {};
  });
}

}  // extern "C"
