// Which faces of a tree of boxes may meet: what a search for meeting faces tests exactly.
#pragma once
#include <cstddef>
#include <cstdint>

#include "kernels/box_lanes.h"
#include "kernels/simd.h"

namespace plc::kernels {

// The lowest two levels of the tree: leaves of 8 faces, nodes of 8 leaves. Face f is lane f % 8 of
// leaf f / 8, a leaf l lane l % 8 of node l / 8; boxes of absent ones overlap nothing. moved: a bit
// per face of a leaf, or leaf of a node: whether it has moved, or has a face that has.
struct FaceBoxes {
  const uint32_t* corners;  // three ids per face, with room for whole leaves
  const BoxLanes* leaves;
  const uint8_t* leaf_moved;
  const BoxLanes* nodes;
  const uint8_t* node_moved;
};

struct CandidatePair {
  uint32_t f, g;
};

// The pairs f < g of faces, f of `leaf`, g of one of these nodes of leaves, one of which has moved,
// that have no common corner and whose boxes overlap (closed). Node by node. Returns how
// many; pairs: room for kMostPairs per node. The same for any `simd`.
inline constexpr size_t kMostPairs = size_t{BoxLanes::kLanes} * BoxLanes::kLanes * BoxLanes::kLanes;
size_t face_pairs(SimdTarget simd, const FaceBoxes& tree, uint32_t leaf, const uint32_t* nodes,
                  size_t count, CandidatePair* pairs);

}  // namespace plc::kernels
