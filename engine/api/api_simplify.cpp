// The C API: simplifying and rounding of any mesh.
#include <algorithm>
#include <cmath>
#include <string>

#include "engine/api/handles.h"
#include "engine/measure/hausdorff.h"
#include "engine/measure/mesh_check.h"
#include "engine/measure/mesh_input.h"
#include "engine/simplify/mesh_rounding.h"
#include "engine/simplify/simplification.h"
#include "pyramid/check_volume.h"

namespace {

// A tolerance is at least so many times what distances are rounded by, so that it can be proved.
constexpr double kLeastTolerance = 100;
// How small distances are told, against the tolerance.
constexpr double kPrecise = 8;

}  // namespace

extern "C" {

plc_status plc_mesh_simplify(plc_context* context, const double* xyz, int64_t vertex_count,
                             const uint32_t* abc, int64_t face_count,
                             const plc_simplify_options* options, double* new_xyz,
                             uint32_t* new_abc, plc_simplified* simplified) {
  return plc::guarded(context, [&]() -> plc::Status {
    plc_simplify_options o;
    plc::Status status = plc::take_struct(options, plc_simplify_options_defaults, "options", o);
    if (!status.ok()) return status;
    if (!(o.tolerance > 0) || !std::isfinite(o.tolerance)) {
      return plc::bad_argument("options: tolerance " + plc::number_text(o.tolerance) +
                               ": must be a finite number > 0");
    }
    if (new_xyz == nullptr || new_abc == nullptr) {
      return plc::bad_argument("new_xyz, new_abc: must not be NULL");
    }
    if (status = plc::check_output(simplified, "simplified"); !status.ok()) return status;
    const plc::Executor& executor = context->host->schedule;
    const plc::MeshArrays given = plc::mesh_arrays(xyz, vertex_count, abc, face_count);
    status = plc::demand_valid(given, executor);
    if (!status.ok()) return status;
    if (const double least = kLeastTolerance * plc::distance_rounding(given); o.tolerance < least) {
      return plc::bad_argument("options: tolerance " + plc::number_text(o.tolerance) +
                               ": distances in this mesh are rounded, at least " +
                               plc::number_text(least) + " can be asked for");
    }
    plc::SimplifiedMesh result;
    plc::SimplifyOptions how{o.tolerance, o.one_sided == 0, {}};
    if (o.progress != nullptr) {
      how.go_on = [&o](double fraction) { return o.progress(fraction, o.progress_user) == 0; };
    }
    status = plc::simplify(given, how, executor, result);
    if (!status.ok()) return status;
    const plc::MeshArrays made = plc::arrays_of(result.xyz, result.abc);
    plc::MeshCheck check;
    status = plc::check_mesh(made, executor, check);
    if (!status.ok()) return status;
    if (check.valid == 0) {
      return {plc::ErrorCode::kInternal,
              "the simplified mesh is not valid: " + plc::fault_of(check)};
    }
    const double precise = o.tolerance / kPrecise;
    const plc::FarthestPlace from = plc::farthest_place(made, given, precise, executor);
    const plc::FarthestPlace to = plc::farthest_place(given, made, precise, executor);
    if (from.at_most > o.tolerance || (how.two_sided && to.at_most > o.tolerance)) {
      return {plc::ErrorCode::kInternal,
              "the simplified mesh is not proved to be within the tolerance"};
    }
    std::copy(result.xyz.begin(), result.xyz.end(), new_xyz);
    std::copy(result.abc.begin(), result.abc.end(), new_abc);
    const plc_simplified out{sizeof out,
                             static_cast<int64_t>(made.vertex_count),
                             static_cast<int64_t>(made.face_count),
                             from.at_least,
                             from.at_most,
                             to.at_least,
                             to.at_most};
    plc::give_struct(out, simplified);
    return {};
  });
}

plc_status plc_mesh_round(plc_context* context, const double* xyz, int64_t vertex_count,
                          const uint32_t* abc, int64_t face_count, float* rounded, int64_t* moved) {
  return plc::guarded(context, [&]() -> plc::Status {
    if (rounded == nullptr) return plc::bad_argument("rounded: must not be NULL");
    const plc::MeshArrays given = plc::mesh_arrays(xyz, vertex_count, abc, face_count);
    const plc::Executor& executor = context->host->schedule;
    if (plc::Status s = plc::check_mesh_input(given, executor); !s.ok()) return s;
    plc::RoundedMesh made;
    if (plc::Status s = plc::round_to_floats(given, executor, made); !s.ok()) return s;
    std::transform(made.xyz.begin(), made.xyz.end(), rounded,
                   [](double x) { return static_cast<float>(x); });
    if (moved != nullptr) *moved = made.moved;
    return {};
  });
}

}  // extern "C"
