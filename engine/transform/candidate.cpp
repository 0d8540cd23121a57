#include "engine/transform/candidate.h"

#include <algorithm>

namespace plc {

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
