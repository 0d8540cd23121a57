// The C API: measuring of any mesh.
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/api/handles.h"
#include "engine/base/mesh_arrays.h"
#include "engine/measure/curvature.h"
#include "engine/measure/geodesic.h"
#include "engine/measure/mesh_input.h"
#include "engine/measure/moments.h"
#include "engine/measure/surface_distance.h"

namespace {

plc_component_measures record_of(const plc::ComponentShape& c) {
  plc_component_measures out{};
  out.struct_size = sizeof out;
  out.first_face = c.first_face;
  out.vertices = c.vertices;
  out.faces = c.faces;
  out.euler = c.euler;
  out.genus = c.genus;
  out.area = c.area;
  out.volume = c.volume;
  std::copy(std::begin(c.low), std::end(c.low), out.low);
  std::copy(std::begin(c.high), std::end(c.high), out.high);
  std::copy(std::begin(c.centroid), std::end(c.centroid), out.centroid);
  std::copy(std::begin(c.moments), std::end(c.moments), out.moments);
  std::copy(std::begin(c.principal_moments), std::end(c.principal_moments), out.principal_moments);
  std::copy(std::begin(c.principal_axes), std::end(c.principal_axes), out.principal_axes);
  return out;
}

}  // namespace

extern "C" {

plc_status plc_mesh_component_measures(plc_context* context, const double* xyz,
                                       int64_t vertex_count, const uint32_t* abc,
                                       int64_t face_count, plc_component_measures* whole,
                                       plc_component_measures* components, int64_t capacity,
                                       int64_t* count) {
  return plc::guarded(context, [&]() -> plc::Status {
    if (whole != nullptr) {
      if (plc::Status s = plc::check_output(whole, "whole"); !s.ok()) return s;
    }
    if (capacity < 0 || (capacity > 0 && components == nullptr)) {
      return plc::bad_argument("components: must not be NULL, capacity must not be negative");
    }
    if (count == nullptr) return plc::bad_argument("count: must not be NULL");
    const plc::MeshArrays mesh = plc::mesh_arrays(xyz, vertex_count, abc, face_count);
    if (plc::Status s = plc::check_mesh_input(mesh, context->host->schedule); !s.ok()) return s;
    const plc::ShapeMeasures shape = plc::shape_measures(mesh, context->host->schedule);
    if (whole != nullptr) plc::give_struct(record_of(shape.whole), whole);
    *count = static_cast<int64_t>(shape.components.size());
    std::transform(shape.components.data(),
                   shape.components.data() + static_cast<size_t>(std::min(capacity, *count)),
                   components, record_of);
    return {};
  });
}

plc_status plc_mesh_curvature(plc_context* context, const double* xyz, int64_t vertex_count,
                              const uint32_t* abc, int64_t face_count, double* mean,
                              double* gaussian, double* area) {
  return plc::guarded(context, [&]() -> plc::Status {
    const plc::MeshArrays mesh = plc::mesh_arrays(xyz, vertex_count, abc, face_count);
    if (plc::Status s = plc::check_mesh_input(mesh, context->host->schedule); !s.ok()) return s;
    plc::vertex_curvature(mesh, context->host->schedule, mean, gaussian, area);
    return {};
  });
}

plc_status plc_mesh_nearest_vertex(plc_context* context, const double* xyz, int64_t vertex_count,
                                   const uint32_t* abc, int64_t face_count, const double* point,
                                   int64_t* vertex) {
  return plc::guarded(context, [&]() -> plc::Status {
    if (point == nullptr || vertex == nullptr) {
      return plc::bad_argument("point, vertex: must not be NULL");
    }
    if (!std::all_of(point, point + 3, [](double x) { return std::isfinite(x); })) {
      return plc::bad_argument("point: expected finite numbers");
    }
    const plc::MeshArrays mesh = plc::mesh_arrays(xyz, vertex_count, abc, face_count);
    if (plc::Status s = plc::check_mesh_input(mesh, context->host->schedule); !s.ok()) return s;
    const size_t nearest = plc::nearest_vertex(mesh, point);
    *vertex = face_count == 0 ? -1 : static_cast<int64_t>(nearest);
    return {};
  });
}

plc_status plc_mesh_geodesic(plc_context* context, const double* xyz, int64_t vertex_count,
                             const uint32_t* abc, int64_t face_count, int64_t source,
                             double* distance) {
  return plc::guarded(context, [&]() -> plc::Status {
    if (distance == nullptr) return plc::bad_argument("distance: must not be NULL");
    const plc::MeshArrays mesh = plc::mesh_arrays(xyz, vertex_count, abc, face_count);
    if (plc::Status s = plc::check_mesh_input(mesh, context->host->schedule); !s.ok()) return s;
    if (source < 0 || source >= vertex_count) {
      return {plc::ErrorCode::kInvalidArgument, "source: is vertex " + std::to_string(source) +
                                                    ", the mesh has " +
                                                    std::to_string(vertex_count)};
    }
    plc::geodesic_distances(mesh, static_cast<uint32_t>(source), context->host->schedule, distance);
    return {};
  });
}

plc_status plc_mesh_distance(plc_context* context, const double* xyz, int64_t vertex_count,
                             const uint32_t* abc, int64_t face_count, const double* other_xyz,
                             int64_t other_vertex_count, const uint32_t* other_abc,
                             int64_t other_face_count, double* distance, plc_distances* summary) {
  return plc::guarded(context, [&]() -> plc::Status {
    if (summary != nullptr) {
      if (plc::Status s = plc::check_output(summary, "summary"); !s.ok()) return s;
    }
    const plc::MeshArrays mesh = plc::mesh_arrays(xyz, vertex_count, abc, face_count);
    if (plc::Status s = plc::check_mesh_input(mesh, context->host->schedule); !s.ok()) return s;
    const plc::MeshArrays other =
        plc::mesh_arrays(other_xyz, other_vertex_count, other_abc, other_face_count);
    if (plc::Status s = plc::check_mesh_input(other, context->host->schedule); !s.ok()) {
      return {s.code(), "the other mesh: " + s.message()};
    }
    if (other_face_count == 0) {
      return {plc::ErrorCode::kInvalidData, "the other mesh: has no face"};
    }
    const plc::SurfaceDistances d =
        plc::surface_distances(mesh, other, context->host->schedule, distance);
    const plc_distances out{sizeof out, d.mean, d.rms, d.max, d.vertex_mean, d.vertex_max};
    if (summary != nullptr) plc::give_struct(out, summary);
    return {};
  });
}

}  // extern "C"
