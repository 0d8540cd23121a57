// What a run will cost, told from the image before it starts, and what no run may go beyond.
#pragma once
#include <cstdint>
#include <vector>

#include "engine/mesh/mesh_space.h"
#include "pyramid/executor.h"
#include "pyramid/pyramid.h"

namespace plc {

// Vertices that a surface within the image can have, at most, on level h: one for each delta^3.
// Sheets as near as (3) allows, of edges of 1.6 delta in the mean, have a third of it. A surface
// with more has left the image, or is crumpled by forces that have no rest. `pad`, below too, as in
// image_view().
double most_vertices(const Pyramid& pyramid, int h, int pad, const MeshScale& scale);

struct Cost {
  double vertices = 0;  // of the level that has most
  double voxels = 0;    // of I_0 without its padding
  double bytes = 0;     // of that level's mesh and of what works on it
};

// Estimated from the voxels' faces between the object and what surrounds it. For smooth objects it
// is right within a third; for noise, which the mesh does not follow, it is too much. isos: of each
// level; where there are none nothing is known, and the cost is 0 but for the voxels.
// from_iso: an adaptive mesh that starts from the iso-surface of I_0.
Cost expected_cost(const Pyramid& pyramid, const std::vector<double>& isos, bool inside_above,
                   int pad, const MeshScale& scale, bool from_iso, const Executor& executor);

}  // namespace plc
