// What other files of the C API ask of surfaces.
#pragma once
#include <vector>

#include "engine/api/frame.h"
#include "engine/api/handles.h"

namespace plc {

// Mesh space to one of the spaces of the API.
Affine affine_of(const plc_surface& surface, plc_space space);
// index: below the number of records.
plc_level_report level_report(const plc_surface& surface, size_t index);

}  // namespace plc
