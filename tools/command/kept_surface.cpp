#include "tools/command/kept_surface.h"

#include <algorithm>

#include "tools/command/engine_handles.h"
#include "tools/command/surface_mesh.h"
#include "tools/mesh/mesh_bodies.h"

namespace plc::tools {

namespace {

plc_measures measures_of_mesh(plc_context* context, const TriangleMesh& mesh) {
  plc_component_measures whole{};
  whole.struct_size = sizeof whole;
  int64_t components = 0;
  demand(context,
         plc_mesh_component_measures(
             context, mesh.xyz.data(), static_cast<int64_t>(mesh.xyz.size() / 3), mesh.abc.data(),
             static_cast<int64_t>(mesh.abc.size() / 3), &whole, nullptr, 0, &components));
  return {sizeof(plc_measures), whole.vertices, whole.faces, components,
          whole.euler,          whole.genus,    whole.area,  whole.volume};
}

}  // namespace

TriangleMesh placed_mesh(plc_context* context, const plc_surface* surface,
                         const ExtractOptions& options) {
  TriangleMesh mesh = mesh_of(context, surface, options.space);
  if (options.box && options.space == PLC_SPACE_VOXEL) {
    for (size_t i = 0; i < mesh.xyz.size(); ++i) {
      mesh.xyz[i] += static_cast<double>(options.box->low[i % 3]);
    }
  }
  return mesh;
}

KeptSurface kept_surface(plc_context* context, const plc_surface* surface,
                         const ExtractOptions& options) {
  KeptSurface result{placed_mesh(context, surface, options), measures_of(context, surface)};
  if (options.keep.text.empty()) return result;
  // Volumes are in mm3, whatever is written; vertices have the same numbers.
  const TriangleMesh lps = mesh_of(context, surface, PLC_SPACE_LPS);
  const Bodies bodies = bodies_of(lps);
  const std::vector<char> kept = kept_by(options.keep, bodies.volumes);
  result.bodies = kept.size();
  result.kept = static_cast<size_t>(std::count(kept.begin(), kept.end(), char{1}));
  if (result.kept == 0) {
    throw Failure{"--keep " + options.keep.text + ": none of the " + std::to_string(result.bodies) +
                  " bodies is as large; the largest has " +
                  text_of(*std::max_element(bodies.volumes.begin(), bodies.volumes.end())) +
                  " mm3"};
  }
  result.mesh = part_of(result.mesh, bodies, kept);
  result.measures = measures_of_mesh(context, part_of(lps, bodies, kept));
  return result;
}

}  // namespace plc::tools
