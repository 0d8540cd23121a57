// A valid mesh rounded to floats, valid still.
#pragma once
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"
#include "pyramid/status.h"

namespace plc {

struct RoundedMesh {
  Vector<double> xyz;  // floats, all of them
  int64_t moved = 0;   // vertices that are not where rounding alone puts them
};

// Where surfaces all but touch, rounding makes faces meet. Corners of such faces are moved apart,
// in the direction that tells the faces apart before rounding, by twice what floats are rounded by
// there, then by twice that, until none meet, or that is more than kMostOfEdge of the shortest edge
// of the two. kInvalidData where the mesh is not valid (mesh_check.h), or no such floats are: a
// component must not turn inside out either, nor a face lose its area. `rounded` is then unchanged.
// The same bits for any executor.
Status round_to_floats(const MeshArrays& mesh, const Executor& executor, RoundedMesh& rounded);

}  // namespace plc
