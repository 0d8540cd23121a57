// The C API: measuring of any mesh.
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/api/handles.h"
#include "engine/measure/curvature.h"
#include "engine/measure/geodesic.h"
#include "engine/measure/mesh_input.h"
#include "engine/measure/moments.h"
#include "engine/measure/surface_distance.h"

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
    plc::Status status =
        plc::check_mesh_input(xyz, vertex_count, abc, face_count, context->host->schedule);
    if (!status.ok()) return status;
    const plc::ShapeMeasures shape =
        plc::shape_measures(xyz, static_cast<size_t>(vertex_count), abc,
                            static_cast<size_t>(face_count), context->host->schedule);
    if (whole != nullptr) plc::give_struct(shape.whole, whole);
    *count = static_cast<int64_t>(shape.components.size());
    std::copy_n(shape.components.begin(), std::min(capacity, *count), components);
    return {};
  });
}

plc_status plc_mesh_curvature(plc_context* context, const double* xyz, int64_t vertex_count,
                              const uint32_t* abc, int64_t face_count, double* mean,
                              double* gaussian, double* area) {
  return plc::guarded(context, [&]() -> plc::Status {
    plc::Status status =
        plc::check_mesh_input(xyz, vertex_count, abc, face_count, context->host->schedule);
    if (!status.ok()) return status;
    plc::vertex_curvature(xyz, static_cast<size_t>(vertex_count), abc,
                          static_cast<size_t>(face_count), context->host->schedule, mean, gaussian,
                          area);
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
    plc::Status status =
        plc::check_mesh_input(xyz, vertex_count, abc, face_count, context->host->schedule);
    if (!status.ok()) return status;
    const size_t nearest = plc::nearest_vertex(xyz, static_cast<size_t>(vertex_count), abc,
                                               static_cast<size_t>(face_count), point);
    *vertex = face_count == 0 ? -1 : static_cast<int64_t>(nearest);
    return {};
  });
}

plc_status plc_mesh_geodesic(plc_context* context, const double* xyz, int64_t vertex_count,
                             const uint32_t* abc, int64_t face_count, int64_t source,
                             double* distance) {
  return plc::guarded(context, [&]() -> plc::Status {
    if (distance == nullptr) return plc::bad_argument("distance: must not be NULL");
    plc::Status status =
        plc::check_mesh_input(xyz, vertex_count, abc, face_count, context->host->schedule);
    if (!status.ok()) return status;
    if (source < 0 || source >= vertex_count) {
      return {plc::ErrorCode::kInvalidArgument, "source: is vertex " + std::to_string(source) +
                                                    ", the mesh has " +
                                                    std::to_string(vertex_count)};
    }
    plc::geodesic_distances(xyz, static_cast<size_t>(vertex_count), abc,
                            static_cast<size_t>(face_count), static_cast<uint32_t>(source),
                            context->host->schedule, distance);
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
    plc::Status status =
        plc::check_mesh_input(xyz, vertex_count, abc, face_count, context->host->schedule);
    if (!status.ok()) return status;
    status = plc::check_mesh_input(other_xyz, other_vertex_count, other_abc, other_face_count,
                                   context->host->schedule);
    if (!status.ok()) return {status.code(), "the other mesh: " + status.message()};
    if (other_face_count == 0) {
      return {plc::ErrorCode::kInvalidData, "the other mesh: has no face"};
    }
    const plc_distances distances = plc::surface_distances(
        {xyz, static_cast<size_t>(vertex_count), abc, static_cast<size_t>(face_count)},
        {other_xyz, static_cast<size_t>(other_vertex_count), other_abc,
         static_cast<size_t>(other_face_count)},
        context->host->schedule, distance);
    if (summary != nullptr) plc::give_struct(distances, summary);
    return {};
  });
}

}  // extern "C"
