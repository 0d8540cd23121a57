// A hierarchy of boxes over the faces of any mesh: the broad phase of exact searches.
//
// Faces are split at the median of their centres along the longest axis, down to leaves of 8: depth
// and build time do not depend on how sizes and positions are spread (a grid fails on one large
// face or one far vertex, space-filling curves on the latter). Nodes are in preorder, so that a
// search is one loop without a stack, and "everything after this leaf" is what pairs it once.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "engine/exact/predicates.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"

namespace plc {

class FaceTree {
 public:
  static constexpr uint32_t kLeafFaces = 8;

  // The faces ids[0 .. count-1] of the triples abc on vertices xyz (three doubles each, finite).
  // The tree is the same for any executor; ids are in no particular order afterwards.
  void build(const double* xyz, const uint32_t* abc, const uint32_t* ids, size_t count,
             const Executor& executor);

  size_t leaf_count() const { return leaves_.size(); }
  size_t face_count() const { return count_; }
  // The faces in the order of the leaves, so that those of neighbouring places are near each other.
  uint32_t face_at(size_t place) const {
    return leaves_[place / kLeafFaces].face[place % kLeafFaces];
  }

  // Calls pair(f, g) for every two faces whose boxes overlap, one of them in leaf `leaf` and the
  // other in the same or a later leaf; over all leaves, once for each pair.
  template <typename Pair>
  void overlapping_pairs(size_t leaf, const Pair& pair) const;

  // Calls visit(f) for every face whose box the segment from s to e may meet.
  template <typename Visit>
  void along_segment(const Point3& s, const Point3& e, const Visit& visit) const;

  // Calls visit(f) for every face whose box overlaps the closed box low .. high, always in the same
  // order.
  template <typename Visit>
  void within(const double* low, const double* high, const Visit& visit) const;

  // The least of `limit` and squared(f) over the faces f: squared() must tell the squared distance
  // from p to face f. It is asked for faces alone whose box is nearer than the least so far, boxes
  // near p first.
  template <typename Squared>
  double nearest(const Point3& p, double limit, const Squared& squared) const;

 private:
  // Doubles, as given: floats would have to be scaled to the mesh, and one far vertex would then
  // leave no digits for the rest.
  struct Box {
    double low[3], high[3];
  };
  // 56 bytes. The nodes of a subtree of n leaves take 2 n - 1 places from its root on.
  struct Node {
    Box box;
    uint32_t first_leaf, leaf_count;
  };
  // Boxes of the faces, one axis after the other; unused places are empty (low > high).
  struct alignas(64) Leaf {
    double low[3][kLeafFaces], high[3][kLeafFaces];
    uint32_t face[kLeafFaces];
  };
  // What is sorted: twice the centre of the box.
  struct Item {
    double centre[3];
    uint32_t face;
  };
  struct Range {
    uint32_t node, first_leaf, leaf_count;
  };

  static bool overlap(const Box& a, const Box& b) {
    return a.low[0] <= b.high[0] && b.low[0] <= a.high[0] && a.low[1] <= b.high[1] &&
           b.low[1] <= a.high[1] && a.low[2] <= b.high[2] && b.low[2] <= a.high[2];
  }
  static Box box_of(const Leaf& leaf, uint32_t k) {
    return {{leaf.low[0][k], leaf.low[1][k], leaf.low[2][k]},
            {leaf.high[0][k], leaf.high[1][k], leaf.high[2][k]}};
  }
  static double squared_distance(const Box& box, const Point3& p) {
    const double at[3] = {p.x, p.y, p.z};
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double below = box.low[axis] - at[axis], above = at[axis] - box.high[axis];
      const double off = below > 0 ? below : above > 0 ? above : 0;
      sum += off * off;
    }
    return sum;
  }
  template <typename Pair>
  static void leaf_pairs(const Leaf& leaf, uint32_t k, const Leaf& other, uint32_t from,
                         const Pair& pair);

  Box face_box(uint32_t face) const;
  Range first_child(const Range& r) const;
  Range second_child(const Range& r) const;
  void split(const Range& r);
  void build_subtree(const Range& r);
  void make_leaf(const Range& r);
  void join_boxes(const Range& r);

  const double* xyz_ = nullptr;  // while building
  const uint32_t* abc_ = nullptr;
  size_t count_ = 0;
  Buffer<Item> items_;
  Buffer<Node> nodes_;
  Buffer<Leaf> leaves_;
  Buffer<uint32_t> leaf_node_;  // the node of each leaf
};

// ---- implementation -------------------------------------------------------------------------

template <typename Pair>
void FaceTree::leaf_pairs(const Leaf& leaf, uint32_t k, const Leaf& other, uint32_t from,
                          const Pair& pair) {
  const Box box = box_of(leaf, k);
  int hit[kLeafFaces];  // all eight at once: no branches, so that it becomes vector code
  for (uint32_t i = 0; i < kLeafFaces; ++i) {
    int apart = 0;
    for (int axis = 0; axis < 3; ++axis) {
      apart |= static_cast<int>(box.low[axis] > other.high[axis][i]) |
               static_cast<int>(other.low[axis][i] > box.high[axis]);
    }
    hit[i] = apart;
  }
  for (uint32_t i = from; i < kLeafFaces; ++i) {
    if (hit[i] == 0) pair(leaf.face[k], other.face[i]);
  }
}

template <typename Pair>
void FaceTree::overlapping_pairs(size_t leaf, const Pair& pair) const {
  const Leaf& own = leaves_[leaf];
  const uint32_t used = static_cast<uint32_t>(
      count_ - leaf * kLeafFaces < kLeafFaces ? count_ - leaf * kLeafFaces : kLeafFaces);
  for (uint32_t k = 0; k < used; ++k) leaf_pairs(own, k, own, k + 1, pair);
  const Box box = nodes_[leaf_node_[leaf]].box;
  for (size_t i = leaf_node_[leaf] + 1U; i < nodes_.size();) {
    const Node& node = nodes_[i];
    if (!overlap(node.box, box)) {
      i += 2 * static_cast<size_t>(node.leaf_count) - 1;
      continue;
    }
    ++i;
    if (node.leaf_count > 1) continue;
    for (uint32_t k = 0; k < used; ++k) {
      if (overlap(box_of(own, k), node.box)) leaf_pairs(own, k, leaves_[node.first_leaf], 0, pair);
    }
  }
}

template <typename Visit>
void FaceTree::along_segment(const Point3& s, const Point3& e, const Visit& visit) const {
  // Every t below has a relative error of a few roundings: far less than this.
  constexpr double kMargin = 1e-14;
  const double from[3] = {s.x, s.y, s.z}, to[3] = {e.x, e.y, e.z};
  const auto meets = [&](const Box& box) {
    double enter = 0, leave = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = box.low[axis] - from[axis], high = box.high[axis] - from[axis];
      const double step = to[axis] - from[axis];
      if (step == 0) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      const double t0 = (step > 0 ? low : high) / step, t1 = (step > 0 ? high : low) / step;
      enter = t0 > enter ? t0 : enter;
      leave = t1 < leave ? t1 : leave;
    }
    return enter - leave <= kMargin * (enter + std::abs(leave));
  };
  for (size_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    if (!meets(node.box)) {
      i += 2 * static_cast<size_t>(node.leaf_count) - 1;
      continue;
    }
    ++i;
    if (node.leaf_count > 1) continue;
    const Leaf& leaf = leaves_[node.first_leaf];
    const size_t first = node.first_leaf * static_cast<size_t>(kLeafFaces);
    for (uint32_t k = 0; k < kLeafFaces && first + k < count_; ++k) {
      if (meets(box_of(leaf, k))) visit(leaf.face[k]);
    }
  }
}

template <typename Visit>
void FaceTree::within(const double* low, const double* high, const Visit& visit) const {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = low[axis];
    box.high[axis] = high[axis];
  }
  for (size_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    if (!overlap(node.box, box)) {
      i += 2 * static_cast<size_t>(node.leaf_count) - 1;
      continue;
    }
    ++i;
    if (node.leaf_count > 1) continue;
    const Leaf& leaf = leaves_[node.first_leaf];
    const size_t first = node.first_leaf * static_cast<size_t>(kLeafFaces);
    for (uint32_t k = 0; k < kLeafFaces && first + k < count_; ++k) {
      if (overlap(box_of(leaf, k), box)) visit(leaf.face[k]);
    }
  }
}

template <typename Squared>
double FaceTree::nearest(const Point3& p, double limit, const Squared& squared) const {
  // A box's distance and a face's are rounded in different ways: a box is passed over only where it
  // is farther by more than that.
  constexpr double kMargin = 1 - 1e-14;
  struct Entry {
    uint32_t node;
    double squared;
  };
  constexpr size_t kMaxDepth = 34;  // a node and its sibling per level of at most 2^32 leaves
  Entry stack[2 * kMaxDepth];
  size_t size = 0;
  const auto push = [&](uint32_t node) {
    stack[size++] = {node, squared_distance(nodes_[node].box, p) * kMargin};
  };
  if (!nodes_.empty()) push(0);
  while (size > 0) {
    const Entry entry = stack[--size];
    if (!(entry.squared < limit)) continue;
    const Node& node = nodes_[entry.node];
    if (node.leaf_count > 1) {
      push(entry.node + 2 * (node.leaf_count / 2));
      push(entry.node + 1);
      if (stack[size - 1].squared > stack[size - 2].squared) {
        std::swap(stack[size - 1], stack[size - 2]);
      }
      continue;
    }
    const Leaf& leaf = leaves_[node.first_leaf];
    const size_t first = node.first_leaf * static_cast<size_t>(kLeafFaces);
    for (uint32_t k = 0; k < kLeafFaces && first + k < count_; ++k) {
      if (!(squared_distance(box_of(leaf, k), p) * kMargin < limit)) continue;
      const double found = squared(leaf.face[k]);
      limit = found < limit ? found : limit;
    }
  }
  return limit;
}

}  // namespace plc
