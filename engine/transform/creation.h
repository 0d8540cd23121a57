// Creation of a vertex on an edge that violates (2): figure 1a.
#pragma once
#include "engine/transform/edge.h"

namespace plc {

// Splits u-v at its mid-point; the faces of the edge become four. Returns the new vertex, which has
// the mean velocity of u and v. Changes the rings of u, v, a, b. Where another face is as near as
// the mid-point's rounding, the halves may meet it: embedding_guard.h tells.
uint32_t create_on_edge(Mesh& mesh, const Edge& edge);

}  // namespace plc
