#include "engine/transform/deletion.h"

#include <algorithm>
#include <cassert>

#include "engine/mesh/turns.h"

namespace plc {

Neighbors common_neighbors(const Mesh& mesh, uint32_t u, uint32_t v) {
  const Neighbors of_v = mesh.ring(v);
  Neighbors common;
  const uint32_t d = mesh.valence(u);
  for (uint32_t k = 0; k < d; ++k) {
    const uint32_t w = mesh.neighbor(u, k);
    if (of_v.contains(w)) common.push_back(w);
  }
  return common;
}

Neighbors merged_ring(const Mesh& mesh, const Edge& e) {
  Neighbors ring;
  const Neighbors of_u = mesh.ring(e.u);
  const Neighbors of_v = mesh.ring(e.v);
  // Around u from b to a, leaving v out, then around v from behind a up to b.
  const uint32_t start = of_u.find(e.b);
  for (uint32_t k = 0; k + 1 < of_u.size(); ++k) {
    ring.push_back(of_u[(start + k) % of_u.size()]);
  }
  const uint32_t after_a = of_v.find(e.a) + 1;
  for (uint32_t k = 0; k + 3 < of_v.size(); ++k) {
    ring.push_back(of_v[(after_a + k) % of_v.size()]);
  }
  return ring;
}

bool can_contract(const Mesh& mesh, const Edge& e) {
  return mesh.valence(e.a) > 3 && mesh.valence(e.b) > 3 &&
         uint64_t{mesh.valence(e.u)} + mesh.valence(e.v) <= uint64_t{mesh.most_neighbors} + 4 &&
         common_neighbors(mesh, e.u, e.v).size() == 2;
}

void delete_edge(Mesh& mesh, const Edge& e, Vec3 place) {
  assert(has_edge(mesh, e) && common_neighbors(mesh, e.u, e.v).size() == 2);
  assert(mesh.valence(e.a) > 3 && mesh.valence(e.b) > 3);
  const Neighbors ring = merged_ring(mesh, e);
  const Neighbors of_v = mesh.ring(e.v);
  mesh.remove(e.a, e.v);
  mesh.remove(e.b, e.v);
  for (const uint32_t x : of_v) {
    if (x != e.u && x != e.a && x != e.b) mesh.replace(x, e.v, e.u);
  }
  mesh.velocity.set(e.u, midpoint(mesh.velocity.at(e.u), mesh.velocity.at(e.v)));
  mesh.turns[e.u] =
      with_turns(mesh.turns[e.u], std::max(turns_of(mesh.turns[e.u]), turns_of(mesh.turns[e.v])));
  mesh.place(e.u, place);
  mesh.set_ring(e.u, ring);
  mesh.destroy(e.v);
}

}  // namespace plc
