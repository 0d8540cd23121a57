// How much of each fine cell is inside the object.
#pragma once
#include <array>
#include <vector>

#include "perf/truth/scene.h"
#include "pyramid/executor.h"

namespace truth {

// Of the box of half sides `half` around a point at signed distance `distance` from a plane with
// normal `normal`, the part on the plane's negative side.
double part_below_plane(const plc::Double3& half, double distance, const plc::Double3& normal);

// One value in [0,1] per fine cell, x fastest; fine[a] cells to a voxel of the scene along axis a.
std::vector<float> inside_parts(const Scene& scene, const std::array<int, 3>& fine,
                                const plc::Executor& executor);

}  // namespace truth
