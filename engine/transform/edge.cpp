#include "engine/transform/edge.h"

namespace plc {

Vec3 vertex_normal(const Mesh& mesh, uint32_t v) {
  const uint32_t d = mesh.valence(v);
  const Vec3 p = mesh.at(v);
  Vec3 sum;
  if (d == 0) return sum;
  Vec3 previous = mesh.at(mesh.neighbor(v, d - 1)) - p;
  for (uint32_t k = 0; k < d; ++k) {
    const Vec3 next = mesh.at(mesh.neighbor(v, k)) - p;
    sum = sum + cross(previous, next);
    previous = next;
  }
  const float norm = length(sum);
  return norm > 0 ? sum * (1.0F / norm) : Vec3{};
}

}  // namespace plc
