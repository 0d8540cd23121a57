// Axial transformation: two parts of the surface that collide are joined (figure 4).
#pragma once
#include <vector>

#include "engine/edge.h"
#include "engine/strip.h"

namespace plc {

// What joining u and v will make, worked out without touching the mesh.
struct AxialPlan {
  uint32_t u, v;
  Neighbors ring_u, ring_v;
  std::vector<Vec3> p, q;  // intermediary vertices on the edges of u and of v, in ring order
  std::vector<Rung> rungs;
};
AxialPlan plan_axial(const Mesh& mesh, uint32_t u, uint32_t v);

// Replaces u and v by the intermediary vertices and the strip between them; u and v must not be
// neighbours. Returns the ids of the new vertices, p first. Changes the rings of the neighbours.
std::vector<uint32_t> join(Mesh& mesh, const AxialPlan& plan);

}  // namespace plc
