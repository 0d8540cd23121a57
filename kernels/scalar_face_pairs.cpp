// Scalar twin of kernels/face_pairs.h.
#include "kernels/scalar.h"

namespace plc::kernels::scalar {

namespace {

bool share_corner(const uint32_t* f, const uint32_t* g) {
  bool share = false;
  for (int i = 0; i < 3; ++i) share |= (f[i] == g[0]) | (f[i] == g[1]) | (f[i] == g[2]);
  return share;
}

// Of `leaf` with a later leaf, or itself.
size_t pairs_of_leaves(const FaceBoxes& tree, uint32_t leaf, uint32_t other, CandidatePair* pairs) {
  constexpr uint32_t kLanes = BoxLanes::kLanes;
  size_t found = 0;
  for (uint32_t k = 0; k < kLanes; ++k) {
    uint32_t hits = tree.leaves[other].overlapping(tree.leaves[leaf].at(k));
    if ((tree.leaf_moved[leaf] >> k & 1) == 0) hits &= tree.leaf_moved[other];
    const uint32_t f = leaf * kLanes + k;
    for (uint32_t l = other == leaf ? k + 1 : 0; l < kLanes; ++l) {
      const uint32_t g = other * kLanes + l;
      if ((hits >> l & 1) == 0) continue;
      if (!share_corner(tree.corners + size_t{3} * f, tree.corners + size_t{3} * g)) {
        pairs[found++] = {f, g};
      }
    }
  }
  return found;
}

}  // namespace

size_t face_pairs(const FaceBoxes& tree, uint32_t leaf, const uint32_t* nodes, size_t count,
                  CandidatePair* pairs) {
  constexpr uint32_t kLanes = BoxLanes::kLanes;
  const Box3 box = tree.nodes[leaf / kLanes].at(leaf % kLanes);
  const bool moved = tree.leaf_moved[leaf] != 0;
  size_t found = 0;
  for (size_t n = 0; n < count; ++n) {
    const uint32_t node = nodes[n];
    uint32_t hits = tree.nodes[node].overlapping(box);
    if (!moved) hits &= tree.node_moved[node];
    for (uint32_t k = 0; k < kLanes; ++k) {
      const uint32_t other = node * kLanes + k;
      if ((hits >> k & 1) != 0 && other >= leaf) {
        found += pairs_of_leaves(tree, leaf, other, pairs + found);
      }
    }
  }
  return found;
}

}  // namespace plc::kernels::scalar
