// What every function on the arrays of a caller's mesh asks of them first.
#pragma once
#include <cstdint>

#include "pyramid/executor.h"
#include "pyramid/status.h"

namespace plc {

// Coordinates are 0 or within these magnitudes: the predicates are exact on them and neither areas
// nor volumes over- or underflow.
inline constexpr double kCoordinateMin = 1e-70;
inline constexpr double kCoordinateMax = 1e70;

// xyz: three values per vertex; abc: three indices per face; NULL only where there are none. At
// most 2^32 vertices and kMaxFaces faces. kInvalidArgument for impossible counts, kInvalidData for
// a value or an index out of range, with a message that names the first one.
Status check_mesh_input(const double* xyz, int64_t vertex_count, const uint32_t* abc,
                        int64_t face_count, const Executor& executor);

}  // namespace plc
