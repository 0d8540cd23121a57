// Inversion of an edge: u-v becomes a-b (figure 1a).
#pragma once
#include "engine/transform/edge.h"

namespace plc {

// The mesh stays a simple closed one when a and b are not neighbours and u and v have more than
// three; neither new face may turn over against the mean of the two old ones.
bool can_invert(const Mesh& mesh, const Edge& edge);

// Changes the rings of u, v, a, b.
void invert_edge(Mesh& mesh, const Edge& edge);

}  // namespace plc
