// Axial transformation: two parts of the surface that collide are joined (figure 4).
#pragma once

#include "engine/transform/edge.h"
#include "engine/transform/strip.h"
#include "pyramid/memory.h"

namespace plc {

// What joining u and v will make, worked out without touching the mesh.
struct AxialPlan {
  uint32_t u, v;
  Neighbors ring_u, ring_v;
  Vector<Vec3> p, q;  // intermediary vertices on the edges of u and of v, in ring order
  Vector<Rung> rungs;
};
AxialPlan plan_axial(const Mesh& mesh, uint32_t u, uint32_t v);

// Replaces u and v by the intermediary vertices and the strip between them; u and v must not be
// neighbours. Returns the ids of the new vertices, p first. Changes the rings of the neighbours.
Vector<uint32_t> join(Mesh& mesh, const AxialPlan& plan);

}  // namespace plc
