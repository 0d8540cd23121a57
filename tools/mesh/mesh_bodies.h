// The bodies that a valid surface bounds: a component that faces outward, and with it the walls of
// the cavities directly inside it, which are components of their own. A body in a cavity of another
// one is its own. Whole bodies can be left out: what is left of a valid surface is valid.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/mesh/mesh_io.h"

namespace plc::tools {

struct Bodies {
  static constexpr uint32_t kNone = 0xffffffffU;

  std::vector<uint32_t> of_vertex;  // the number of its body; kNone for one of no face
  std::vector<double> volumes;      // without cavities, in the unit of the coordinates; by number
};

// Of a mesh that is closed, oriented and free of self-intersections.
Bodies bodies_of(const TriangleMesh& mesh);

// The mesh of the bodies that are marked, with their normals and values. Order is kept.
TriangleMesh part_of(const TriangleMesh& mesh, const Bodies& bodies, const std::vector<char>& kept);

}  // namespace plc::tools
