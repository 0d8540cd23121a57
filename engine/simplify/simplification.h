// A mesh of fewer vertices within a distance of another: collapses of edges, the cheapest first.
#pragma once
#include <cstdint>
#include <functional>

#include "engine/base/mesh_arrays.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"
#include "pyramid/status.h"

namespace plc {

struct SimplifiedMesh {
  Vector<double> xyz;
  Vector<uint32_t> abc;
};

struct SimplifyOptions {
  double tolerance;                   // > 0
  bool two_sided = true;              // whether the given mesh is to be near the result, too
  std::function<bool(double)> go_on;  // (fraction), now and then; false cancels; may be empty
};

// The mesh is valid (mesh_check.h), and so is the result; no place of the result is farther than
// the tolerance from the mesh nor, two-sided, a place of the mesh from the result. Where all
// coordinates are floats, those of the result are. kCancelled where go_on returns false. The same
// bits for any executor.
Status simplify(const MeshArrays& mesh, const SimplifyOptions& options, const Executor& executor,
                SimplifiedMesh& result);

}  // namespace plc
