#include "engine/detect/proximity.h"

#include <algorithm>

#include "engine/base/constants.h"
#include "engine/transform/inversion.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// The edge a-b whose two faces have the apexes u and w, if any.
std::optional<Edge> edge_across(const Neighbors& of_u, const Mesh& mesh, uint32_t u, uint32_t w) {
  const Neighbors of_w = mesh.ring(w);
  for (uint32_t k = 0; k < of_u.size(); ++k) {
    const uint32_t a = of_u[k];
    const uint32_t b = of_u.next(k);
    const uint32_t j = of_w.find(b);
    // (u, a, b) is a face; the other face of a-b is (w, b, a).
    if (j < of_w.size() && of_w.next(j) == a) return Edge{a, b, w, u};
  }
  return std::nullopt;
}

bool freshly_cut(const Mesh& mesh, uint32_t u, uint32_t w, uint32_t iteration) {
  if (mesh.cut_id[u] == 0 || mesh.cut_id[u] != mesh.cut_id[w]) return false;
  if (iteration - mesh.cut_iteration[u] >= kCutExemption) return false;
  const Vec3 speed = mesh.velocity.at(w) - mesh.velocity.at(u);
  return dot(speed, mesh.at(w) - mesh.at(u)) >= 0;
}

std::optional<Candidate> classify(const Mesh& mesh, const Neighbors& of_u, uint32_t u, uint32_t w,
                                  uint32_t iteration) {
  const float distance2 = squared_distance(mesh.at(u), mesh.at(w));
  if (const auto across = edge_across(of_u, mesh, u, w)) {
    const float across2 = squared_distance(mesh.at(across->u), mesh.at(across->v));
    if (distance2 >= across2 || !can_invert(mesh, *across)) return std::nullopt;
    return Candidate{Operation::kInversion, distance2, *across};
  }
  if (freshly_cut(mesh, u, w, iteration)) return std::nullopt;
  const Vec3 normal = vertex_normal(mesh, u);
  if (dot(normal, vertex_normal(mesh, w)) > kAxialMaxNormalDot) {
    return std::nullopt;
  }
  // What lies between is what the surface says that it is.
  if (mesh.sizing != nullptr) {
    const Vec3 between = mesh.at(w) - mesh.at(u);
    const bool enclosed = (dot(normal, between) < 0) != mesh.inside_out;
    if (mesh.sizing->inside(midpoint(mesh.at(u), mesh.at(w))) == enclosed) return std::nullopt;
  }
  return Candidate{Operation::kAxial, distance2, {std::min(u, w), std::max(u, w), 0, 0}};
}

}  // namespace

std::optional<Candidate> pair_candidate(const Mesh& mesh, uint32_t u, uint32_t w,
                                        uint32_t iteration) {
  if (!mesh.alive(u) || !mesh.alive(w)) return std::nullopt;
  if (mesh.is_held(u) || mesh.is_held(w)) return std::nullopt;
  const float reach = kMinApart * mesh.size_between(u, w);
  if (squared_distance(mesh.at(u), mesh.at(w)) >= reach * reach) return std::nullopt;
  const Neighbors ring = mesh.ring(u);
  return ring.contains(w) ? std::nullopt : classify(mesh, ring, u, w, iteration);
}

void proximity_candidates(const Mesh& mesh, const SpatialHash& hash, uint32_t u,
                          const Vector<uint32_t>& pending, uint32_t stamp, uint32_t iteration,
                          Vector<Candidate>& candidates) {
  if (mesh.is_held(u)) return;
  const float reach = mesh.far_reach(kMinApart, mesh.size(u));
  const Vec3 p = mesh.at(u);
  const Neighbors ring = mesh.ring(u);
  const Vec3 span{reach, reach, reach};
  const size_t most = candidates.size() + kMostNear;
  hash.visit_box(mesh, p - span, p + span, [&](uint32_t w, Vec3 q) {
    const float near = kMinApart * mesh.size_between(u, w);
    if (candidates.size() == most || w == u || squared_distance(p, q) >= near * near) return;
    if (pending[w] == stamp && w < u) return;
    if (ring.contains(w) || mesh.is_held(w)) return;
    if (const auto candidate = classify(mesh, ring, u, w, iteration)) {
      candidates.push_back(*candidate);
    }
  });
}

}  // namespace plc
