// What the commands take from a surface of the engine.
#pragma once
#include "engine/pellicle.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

// With normals. Throws Failure.
TriangleMesh mesh_of(plc_context* context, const plc_surface* surface, plc_space space);

// In patient space (mm). Throws Failure.
plc_measures measures_of(plc_context* context, const plc_surface* surface);

}  // namespace plc::tools
