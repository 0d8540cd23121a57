// What every function on the arrays of a caller's mesh asks of them first.
#pragma once
#include <cstdint>

#include "engine/base/mesh_arrays.h"
#include "pyramid/executor.h"
#include "pyramid/status.h"

namespace plc {

// Coordinates are 0 or within these magnitudes: the predicates are exact on them and neither areas
// nor volumes over- or underflow.
inline constexpr double kCoordinateMin = 1e-70;
inline constexpr double kCoordinateMax = 1e70;

// Any arrays: at most 2^32 vertices and kMaxFaces faces are possible, NULL only where there are
// none. kInvalidArgument for impossible counts (told as the signed numbers that callers give),
// kInvalidData for a value or an index out of range, with a message that names the first one.
Status check_mesh_input(const MeshArrays& mesh, const Executor& executor);

}  // namespace plc
