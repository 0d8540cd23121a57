#include "engine/detect/edge_constraints.h"

#include <algorithm>

#include "engine/base/constants.h"
#include "engine/detect/denied_cycles.h"
#include "engine/transform/deletion.h"
#include "engine/transform/inversion.h"

namespace plc {

namespace {

// The common neighbour o, not an apex, that makes the shortest cycle u, v, o; none: the edge can be
// deleted.
std::optional<uint32_t> shortest_cycle(const Mesh& mesh, const Edge& e) {
  std::optional<uint32_t> best;
  float best_length = 0;
  for (const uint32_t o : common_neighbors(mesh, e.u, e.v)) {
    if (o == e.a || o == e.b) continue;
    const float around = length(mesh.at(o) - mesh.at(e.u)) + length(mesh.at(o) - mesh.at(e.v));
    if (!best || around < best_length || (around == best_length && o < *best)) {
      best = o;
      best_length = around;
    }
  }
  return best;
}

bool should_invert(const Mesh& mesh, const Edge& e, float squared_length) {
  const float delta = mesh.size_between(e.u, e.v);
  const Vec3 middle = midpoint(mesh.at(e.u), mesh.at(e.v));
  const float nearest =
      std::min(squared_distance(middle, mesh.at(e.a)), squared_distance(middle, mesh.at(e.b)));
  return nearest <= delta * delta &&
         squared_distance(mesh.at(e.a), mesh.at(e.b)) < squared_length && can_invert(mesh, e);
}

}  // namespace

std::optional<Candidate> edge_candidate(const Mesh& mesh, uint32_t u, uint32_t k) {
  const Edge e = edge_at(mesh, u, k);
  if (mesh.is_held(u) && mesh.is_held(e.v)) return std::nullopt;
  const float delta = mesh.size_between(u, e.v);
  const float shortest = delta * delta;
  const float longest = kMaxEdge * kMaxEdge * delta * delta;
  const float l2 = squared_distance(mesh.at(u), mesh.at(e.v));
  if (l2 <= shortest) {
    if (const auto o = shortest_cycle(mesh, e)) {
      const Cycle cycle{{e.u, e.v, *o}};
      if (mesh.sizing != nullptr && image_has(mesh, cycle)) return std::nullopt;
      return cut_along(cycle, l2);
    }
    return Candidate{Operation::kDeletion, l2, e};
  }
  if (l2 >= longest) {
    const bool invert = should_invert(mesh, e, l2);
    return Candidate{invert ? Operation::kInversion : Operation::kCreation, -l2, e};
  }
  return std::nullopt;
}

}  // namespace plc
