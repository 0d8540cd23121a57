// Constraint (3): pairs of non-neighbours that are too near, and what they ask for (3.2, 3.3).
#pragma once
#include <optional>

#include "engine/detect/spatial_hash.h"
#include "engine/transform/candidate.h"
#include "pyramid/memory.h"

namespace plc {

// What the pair (u, w), u < w, asks for, if it violates (3).
std::optional<Candidate> pair_candidate(const Mesh& mesh, uint32_t u, uint32_t w,
                                        uint32_t iteration);

// Appends what the pairs (u, w) that violate (3) ask for. A pair is taken from u when w is not
// `pending`, or from its smaller id. May append a candidate twice.
//   opposite across an edge a-b: a flat quadrilateral or a crease, no collision: inversion of a-b
//     when u-w is shorter and the inversion is allowed, else nothing
//   freshly cut from each other and not approaching: nothing
//   normals that agree (dot > 0.5): one sheet, nothing
//   else: an axial transformation
void proximity_candidates(const Mesh& mesh, const SpatialHash& hash, uint32_t u,
                          const Vector<uint32_t>& pending, uint32_t stamp, uint32_t iteration,
                          Vector<Candidate>& candidates);

}  // namespace plc
