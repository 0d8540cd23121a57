// From what a caller asks for (plc_parameters) to what the engine runs with: checked and derived.
#pragma once
#include "engine/pellicle.h"
#include "engine/recover/recovery.h"
#include "pyramid/pyramid.h"
#include "pyramid/status.h"
#include "pyramid/window.h"

namespace plc {

// Checks every field, and those that go together. The message names the parameter, its value and
// the range.
Status check_parameters(const plc_parameters& parameters);

// Whether the mesh is to be an adaptive one.
bool is_adaptive(const plc_parameters& parameters);

// Above I_0, where a surface does not start on it.
int usual_levels(const VolumeView& volume, const plc_parameters& parameters);

// Fills in what is NAN or -1: window, pad value, level count. `range` is that of the image;
// `window` is set to what the image tells, where something is to be derived of that. memory_limit:
// of the context, 0: none. Errors: kInvalidArgument, kInvalidData (constant or not finite image,
// iso outside the range).
Status derive_parameters(const VolumeView& volume, const VoxelRange& range,
                         const Executor& executor, int64_t memory_limit, plc_parameters& parameters,
                         DerivedWindow& window);

// Image units to [0,1] of the window and back.
inline double normalised(const plc_parameters& p, double value) {
  return (value - p.window_low) / (p.window_high - p.window_low);
}
inline double denormalised(const plc_parameters& p, double value) {
  return p.window_low + value * (p.window_high - p.window_low);
}

// How far the iso-value of a coarse level, normalised, may go from that of I_0 towards the
// background: the rest of the way is where the object's surroundings would be taken for it.
double level_iso_bound(const plc_parameters& parameters, double background);

PyramidSpec pyramid_spec(const plc_parameters& parameters);

// Fills in the kind of mesh, and what is 0 of its lengths. unit: U_0, side: the image's shortest
// one, mm. Errors: kInvalidArgument, edges that the image's voxels do not allow.
Status derive_mesh(double unit, double side, plc_parameters& parameters);

// Fills in the start, where that is PLC_INIT_AUTO; after derive_mesh(). A bubble comes by
// attachments and pins; an iso-surface may be too coarse there.
void derive_init(const plc_extras& extras, plc_parameters& parameters);

// Everything but the iso-values of the levels and what plc_extras holds. unit: U_0, mm.
RecoverySpec recovery_spec(const plc_parameters& parameters, double unit);

}  // namespace plc
