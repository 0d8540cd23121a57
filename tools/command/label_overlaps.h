// Which of several closed surfaces overlap.
#pragma once
#include <cstddef>
#include <vector>

#include "engine/pellicle.h"
#include "tools/mesh/mesh_io.h"

namespace plc::tools {

// Surfaces first < second that meet, or of which one lies inside the other; first == second: a
// surface that is not valid by itself.
struct Overlap {
  size_t first, second;
  bool nested;  // they do not meet: `outer` has no cavity where the other one lies
  size_t outer;
};

// Exact. All meshes together make one valid surface when, and only when, no two of them overlap and
// each is valid: a mesh in another's cavity is turned as that demands. Empty ones are left out.
// as_floats: of the coordinates rounded to floats.
bool disjoint(plc_context* context, const std::vector<const TriangleMesh*>& meshes, bool as_floats);

// Those in which one of the meshes marked in `changed` has a part; in ascending order. Only meshes
// whose boxes overlap are compared, by the faces that lie where the boxes do: with whole meshes
// only where one may lie inside the other.
std::vector<Overlap> find_overlaps(plc_context* context,
                                   const std::vector<const TriangleMesh*>& meshes,
                                   const std::vector<char>& changed);

}  // namespace plc::tools
