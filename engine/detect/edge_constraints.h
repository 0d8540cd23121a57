// Constraints (1) and (2): which transformation an edge asks for (3.2, 3.3).
#pragma once
#include <optional>

#include "engine/transform/candidate.h"

namespace plc {

// What the edge to neighbour k of u asks for, u the smaller id of its ends; nothing when it is
// within (1) and (2).
//   too short: a deletion, or an annular transformation along the shortest cycle when the ends have
//     more than two common neighbours; nothing where the image has what that would cut
//   too long: an inversion when the mid-point would lie within delta of an apex and the inverted
//     edge is shorter and allowed, else a creation
std::optional<Candidate> edge_candidate(const Mesh& mesh, uint32_t u, uint32_t k);

}  // namespace plc
