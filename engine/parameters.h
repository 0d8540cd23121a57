// From what a caller asks for (plc_parameters) to what the engine runs with: checked and derived.
#pragma once
#include "engine/pellicle.h"
#include "engine/recovery.h"
#include "pyramid/pyramid.h"
#include "pyramid/status.h"

namespace plc {

// Checks every field on its own. The message names the parameter, its value and the range.
Status check_parameters(const plc_parameters& parameters);

// Fills in what is NAN or -1: window, pad value, level count. `range` is that of the image.
// Errors: kInvalidArgument, kInvalidData (constant or not finite image, iso outside the range).
Status derive_parameters(const VolumeView& volume, const VoxelRange& range,
                         const Executor& executor, plc_parameters& parameters);

// Image units to [0,1] of the window and back.
inline double normalised(const plc_parameters& p, double value) {
  return (value - p.window_low) / (p.window_high - p.window_low);
}
inline double denormalised(const plc_parameters& p, double value) {
  return p.window_low + value * (p.window_high - p.window_low);
}

PyramidSpec pyramid_spec(const plc_parameters& parameters);
// Everything but the iso-values of the levels.
RecoverySpec recovery_spec(const plc_parameters& parameters, const std::array<double, 3>& spacing);

}  // namespace plc
