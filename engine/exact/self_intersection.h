// All pairs of faces that meet elsewhere than in the vertex or edge they share.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "engine/base/mesh_arrays.h"
#include "engine/exact/face_tree.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// (f, g) with f < g.
using FacePair = std::pair<uint32_t, uint32_t>;

// Any mesh with coordinates within the range of predicates.h and fewer than 2^32 faces. Sorted.
// What counts is in triangle_intersection.h: exact, touching included, faces of zero area left out.
//
// With a limit the search ends early once at least so many pairs are found; of those found the
// first `limit` are returned. Which ones are found depends on the mesh only, not on the executor.
// Memory is O(face_count + pairs); time is proportional to the pairs of faces whose boxes overlap,
// whatever the sizes of faces - all pairs only where all faces share one place (a fan of n
// needles).
Vector<FacePair> self_intersections(const MeshArrays& mesh, const Executor& executor,
                                    size_t limit = std::numeric_limits<size_t>::max());

// The same on a tree of all faces that are not of zero area.
Vector<FacePair> self_intersections(const MeshArrays& mesh, const FaceTree& tree,
                                    const Executor& executor,
                                    size_t limit = std::numeric_limits<size_t>::max());

// The faces that are not of exactly zero area, in order.
Vector<uint32_t> proper_faces(const MeshArrays& mesh, const Executor& executor);

}  // namespace plc
