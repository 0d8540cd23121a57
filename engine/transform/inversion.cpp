#include "engine/transform/inversion.h"

#include <cassert>

namespace plc {

bool can_invert(const Mesh& mesh, const Edge& e) {
  if (mesh.valence(e.u) <= 3 || mesh.valence(e.v) <= 3) return false;
  if (e.a == e.b || mesh.adjacent(e.a, e.b)) return false;
  const Vec3 old_area = area_vector(mesh, e.u, e.a, e.v) + area_vector(mesh, e.u, e.v, e.b);
  return dot(area_vector(mesh, e.u, e.a, e.b), old_area) > 0 &&
         dot(area_vector(mesh, e.a, e.v, e.b), old_area) > 0;
}

void invert_edge(Mesh& mesh, const Edge& e) {
  assert(has_edge(mesh, e) && e.a != e.b && !mesh.adjacent(e.a, e.b));
  assert(mesh.valence(e.u) > 3 && mesh.valence(e.v) > 3);
  mesh.remove(e.u, e.v);
  mesh.remove(e.v, e.u);
  mesh.insert_after(e.a, e.v, e.b);
  mesh.insert_after(e.b, e.u, e.a);
}

}  // namespace plc
