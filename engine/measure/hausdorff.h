// How far a mesh is from another one at most: proved, not sampled.
#pragma once
#include "engine/base/mesh_arrays.h"
#include "pyramid/executor.h"

namespace plc {

// Of the largest distance from a place of one mesh to the nearest place of the other: one that a
// place has, and one that no place exceeds, but for rounding.
struct FarthestPlace {
  double at_least = 0, at_most = 0;
};

// No distance from the mesh is told more exactly than this.
double distance_rounding(const MeshArrays& mesh);

// Both meshes have a face, and inputs as check_mesh_input() has them. at_most is no more than 2 %
// above the larger of at_least and `precise`, > 0: the smaller that is, the more pieces are looked
// at. The same bits for any executor.
FarthestPlace farthest_place(const MeshArrays& mesh, const MeshArrays& other, double precise,
                             const Executor& executor);

}  // namespace plc
