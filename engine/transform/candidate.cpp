#include "engine/transform/candidate.h"

#include <algorithm>

#include "engine/mesh/turns.h"

namespace plc {

namespace {

// visit(v) for the vertices that a topological transformation takes apart.
template <typename Visit>
void visit_corners(const Candidate& candidate, const Visit& visit) {
  if (candidate.operation == Operation::kAnnular) {
    const Cycle cycle = candidate.cycle();
    for (uint32_t i = 0; i < cycle.size; ++i) visit(cycle.corner[i]);
    return;
  }
  visit(candidate.edge.u);
  visit(candidate.edge.v);
}

}  // namespace

bool spares_held(const Mesh& mesh, const Candidate& candidate) {
  const Edge& e = candidate.edge;
  const bool u = mesh.is_held(e.u), v = mesh.is_held(e.v);
  switch (candidate.operation) {
    case Operation::kCreation:
      return !(u && v && (mesh.is_held(e.a) || mesh.is_held(e.b)));
    case Operation::kInversion: {
      const bool a = mesh.is_held(e.a), b = mesh.is_held(e.b);
      return !(u && v && (a || b)) && !(a && b && (u || v));
    }
    case Operation::kDeletion:
      // Where an apex has valence 3 a tetrahedron is deleted.
      return !u && !v &&
             ((mesh.valence(e.a) > 3 && mesh.valence(e.b) > 3) ||
              (!mesh.is_held(e.a) && !mesh.is_held(e.b)));
    case Operation::kAnnular: {
      bool held = false;
      visit_corners(candidate, [&](uint32_t w) { held = held || mesh.is_held(w); });
      return !held;
    }
    case Operation::kAxial:
      break;
  }
  return !u && !v;
}

bool goes_in_circles(const Mesh& mesh, const Candidate& candidate) {
  if (candidate.operation != Operation::kAnnular && candidate.operation != Operation::kAxial) {
    return false;
  }
  // The image has said that what is cut is not there (edge_constraints.h).
  if (mesh.sizing != nullptr && candidate.operation == Operation::kAnnular) return false;
  uint32_t turns = 0;
  visit_corners(candidate, [&](uint32_t v) { turns = std::max(turns, turns_of(mesh.turns[v])); });
  return turns >= (candidate.operation == Operation::kAnnular ? kFreeTurns : kFrozenTurns);
}

void freeze(Mesh& mesh, const Candidate& candidate) {
  visit_corners(candidate,
                [&](uint32_t v) { mesh.turns[v] = with_turns(mesh.turns[v], kFrozenTurns); });
}

bool fits_neighbors(const Mesh& mesh, const Candidate& candidate) {
  const Edge& e = candidate.edge;
  const uint64_t most = mesh.most_neighbors;
  const uint64_t ends = uint64_t{mesh.valence(e.u)} + mesh.valence(e.v);
  switch (candidate.operation) {
    case Operation::kAnnular:
      return true;  // parts of rings
    case Operation::kDeletion:
      return ends <= most + 4;
    case Operation::kInversion:
    case Operation::kCreation:
      return std::max(mesh.valence(e.a), mesh.valence(e.b)) < most;
    case Operation::kAxial:
      break;
  }
  // An intermediary vertex gets four, and at most one for each of the other end's; a neighbour gets
  // one more for each end.
  if (ends + 4 > most) return false;
  for (const uint32_t v : {e.u, e.v}) {
    for (uint32_t k = 0; k < mesh.valence(v); ++k) {
      if (mesh.valence(mesh.neighbor(v, k)) + uint64_t{2} > most) return false;
    }
  }
  return true;
}

}  // namespace plc
