// A surface of the engine as `pellicle extract` writes it: what --keep leaves of it, where --box
// puts it.
#pragma once
#include <cstddef>

#include "engine/pellicle.h"
#include "tools/command/extract_options.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

// In the space of the options, with normals. Voxels are those of the whole image. All bodies are
// there. Throws Failure.
TriangleMesh placed_mesh(plc_context* context, const plc_surface* surface,
                         const ExtractOptions& options);

struct KeptSurface {
  TriangleMesh mesh;
  plc_measures measures;  // of it, in patient space (mm)
  size_t bodies = 0;      // of the surface; 0: it has not been asked for
  size_t kept = 0;        // of them
};

// Throws Failure, also where nothing is kept.
KeptSurface kept_surface(plc_context* context, const plc_surface* surface,
                         const ExtractOptions& options);

}  // namespace plc::tools
