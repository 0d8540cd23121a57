// The combinatorial invariants of the mesh: closed, oriented, rings consistent, graph simple.
#pragma once
#include <string>

#include "engine/mesh/mesh.h"

namespace plc {

// Empty when all hold; else a line that names the first vertex where one does not:
//   valence >= 3; neighbours alive, distinct, not v itself; w in the ring of v after x means v in
//   the ring of x after w (each face is seen alike from its corners); one ring is one umbrella by
//   construction; finite positions; free list and counts agree.
std::string broken_invariant(const Mesh& mesh);

}  // namespace plc
