#include "engine/transform/edge.h"

namespace plc {

namespace {

// visit(normal, as long as twice the area) for the faces of a vertex.
template <typename Visit>
void visit_normals(const Mesh& mesh, uint32_t v, const Visit& visit) {
  const uint32_t d = mesh.valence(v);
  if (d == 0) return;
  const Vec3 p = mesh.at(v);
  Vec3 previous = mesh.at(mesh.neighbor(v, d - 1)) - p;
  for (uint32_t k = 0; k < d; ++k) {
    const Vec3 next = mesh.at(mesh.neighbor(v, k)) - p;
    visit(cross(previous, next));
    previous = next;
  }
}

Vec3 normal_sum(const Mesh& mesh, uint32_t v) {
  Vec3 sum;
  visit_normals(mesh, v, [&](Vec3 n) { sum = sum + n; });
  return sum;
}

}  // namespace

Vec3 vertex_normal(const Mesh& mesh, uint32_t v) {
  const Vec3 sum = normal_sum(mesh, v);
  const float norm = length(sum);
  return norm > 0 ? sum * (1.0F / norm) : Vec3{};
}

bool bends(const Mesh& mesh, uint32_t v, float cosine) {
  return normals_bend([&](const auto& use) { visit_normals(mesh, v, use); }, cosine);
}

}  // namespace plc
