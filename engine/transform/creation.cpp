#include "engine/transform/creation.h"

#include <cassert>

#include "engine/mesh/turns.h"

namespace plc {

uint32_t create_on_edge(Mesh& mesh, const Edge& e) {
  assert(has_edge(mesh, e));
  const Vec3 speed = midpoint(mesh.velocity.at(e.u), mesh.velocity.at(e.v));
  const uint32_t w = mesh.create(midpoint(mesh.at(e.u), mesh.at(e.v)), speed);
  mesh.turns[w] = turns_between(mesh.turns[e.u], mesh.turns[e.v]);
  Neighbors ring;
  for (const uint32_t x : {e.u, e.a, e.v, e.b}) ring.push_back(x);
  mesh.set_ring(w, ring);
  mesh.replace(e.u, e.v, w);
  mesh.replace(e.v, e.u, w);
  mesh.insert_after(e.a, e.v, w);
  mesh.insert_after(e.b, e.u, w);
  return w;
}

}  // namespace plc
