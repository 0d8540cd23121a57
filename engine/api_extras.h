// From plc_extras to what the engine runs with: places in voxels, initial surfaces.
#pragma once
#include "engine/frame.h"
#include "engine/pellicle.h"
#include "engine/recovery.h"
#include "pyramid/status.h"

namespace plc {

// Checks all that can be told without the image, for the init of the parameters.
Status check_extras(const plc_extras& extras, const plc_parameters& parameters,
                    const plc_image& image);

// Seeds, mesh, attachments and pins; not the mask, which needs the pyramid's spec.
void take_extras(const plc_extras& extras, const Frame& frame, RecoverySpec& spec);

}  // namespace plc
