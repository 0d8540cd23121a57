// What the engine finds on a mesh, as the records of the C API.
#pragma once
#include "engine/measure/measures.h"
#include "engine/measure/mesh_check.h"
#include "engine/pellicle.h"

namespace plc {

plc_measures record_of(const SurfaceMeasures& measures);
plc_check record_of(const MeshCheck& check);

}  // namespace plc
