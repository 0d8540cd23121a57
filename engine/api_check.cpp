// The C API: measures of a surface and checks of any mesh.
#include "engine/handles.h"
#include "engine/measures.h"
#include "engine/mesh_check.h"

extern "C" {

plc_status plc_surface_measure(plc_context* context, const plc_surface* surface, plc_space space,
                               plc_measures* measures) {
  if (context == nullptr) return PLC_INVALID_ARGUMENT;
  return plc::guarded(context, [&]() -> plc::Status {
    if (surface == nullptr || measures == nullptr || measures->struct_size != sizeof *measures) {
      return {plc::ErrorCode::kInvalidArgument,
              "surface, measures: must not be NULL, struct_size must be set"};
    }
    std::vector<float> xyz(static_cast<size_t>(plc_surface_vertex_count(surface)) * 3);
    std::vector<uint32_t> abc(static_cast<size_t>(plc_surface_face_count(surface)) * 3);
    plc_surface_positions(surface, space, xyz.data());
    plc_surface_faces(surface, space, abc.data());
    *measures = plc::surface_measures(xyz.data(), xyz.size() / 3, abc.data(), abc.size() / 3,
                                      context->schedule);
    measures->struct_size = sizeof *measures;
    return {};
  });
}

plc_status plc_check_mesh(plc_context* context, const double* xyz, int64_t vertex_count,
                          const uint32_t* abc, int64_t face_count, plc_check* check) {
  if (context == nullptr) return PLC_INVALID_ARGUMENT;
  return plc::guarded(context, [&]() -> plc::Status {
    if (check == nullptr || check->struct_size != sizeof *check) {
      return {plc::ErrorCode::kInvalidArgument, "check: must not be NULL, struct_size must be set"};
    }
    return plc::check_mesh(xyz, vertex_count, abc, face_count, context->schedule, *check);
  });
}

}  // extern "C"
