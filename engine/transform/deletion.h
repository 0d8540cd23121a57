// Deletion of an edge that violates (1): its ends merge at the mid-point (figure 1b).
#pragma once
#include "engine/transform/edge.h"

namespace plc {

// The common neighbours of u and v, in the order of the ring of u; always a and b among them.
Neighbors common_neighbors(const Mesh& mesh, uint32_t u, uint32_t v);

// The ring that the merged vertex will have.
Neighbors merged_ring(const Mesh& mesh, const Edge& edge);

// Whether the surface stays a manifold, and no vertex gets too many neighbours.
bool can_contract(const Mesh& mesh, const Edge& edge);

// Merges v into u at `place`. u and v have exactly two common neighbours, a and b, of valence
// above 3. Changes the rings of u, the neighbours of v, a and b.
void delete_edge(Mesh& mesh, const Edge& edge, Vec3 place);

}  // namespace plc
