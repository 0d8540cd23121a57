#include "engine/exact/face_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/blocks.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

// Faces per task of the passes over all faces.
constexpr size_t kBlock = 4096;
// The top of the tree is built level by level down to this many subtrees, then each is one task.
constexpr size_t kSubtrees = 64;

}  // namespace

FaceTree::Box FaceTree::face_box(uint32_t face) const {
  const uint32_t* ids = abc_ + 3 * static_cast<size_t>(face);
  Box box{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const double p = xyz_[3 * static_cast<size_t>(ids[0]) + axis];
    const double q = xyz_[3 * static_cast<size_t>(ids[1]) + axis];
    const double r = xyz_[3 * static_cast<size_t>(ids[2]) + axis];
    box.low[axis] = std::min(std::min(p, q), r);
    box.high[axis] = std::max(std::max(p, q), r);
  }
  return box;
}

FaceTree::Range FaceTree::first_child(const Range& r) const {
  return {r.node + 1, r.first_leaf, r.leaf_count / 2};
}

FaceTree::Range FaceTree::second_child(const Range& r) const {
  const uint32_t half = r.leaf_count / 2;
  return {r.node + 2 * half, r.first_leaf + half, r.leaf_count - half};
}

// Moves the faces that belong to the first child to the front. Keys are unique, so the two sets do
// not depend on how the library's nth_element works.
void FaceTree::split(const Range& r) {
  Item* begin = items_.data() + r.first_leaf * static_cast<size_t>(kLeafFaces);
  Item* end = items_.data() +
              std::min(count_, (r.first_leaf + static_cast<size_t>(r.leaf_count)) * kLeafFaces);
  double low[3] = {begin->centre[0], begin->centre[1], begin->centre[2]};
  double high[3] = {low[0], low[1], low[2]};
  for (const Item* item = begin; item != end; ++item) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], item->centre[axis]);
      high[axis] = std::max(high[axis], item->centre[axis]);
    }
  }
  int axis = 0;
  if (high[1] - low[1] > high[axis] - low[axis]) axis = 1;
  if (high[2] - low[2] > high[axis] - low[axis]) axis = 2;
  std::nth_element(begin, begin + r.leaf_count / 2 * static_cast<size_t>(kLeafFaces), end,
                   [axis](const Item& a, const Item& b) {
                     if (a.centre[axis] != b.centre[axis]) return a.centre[axis] < b.centre[axis];
                     return a.face < b.face;
                   });
}

void FaceTree::make_leaf(const Range& r) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Leaf& leaf = leaves_[r.first_leaf];
  Box all{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  const size_t first = r.first_leaf * static_cast<size_t>(kLeafFaces);
  for (size_t k = 0; k < kLeafFaces; ++k) {
    Box box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    leaf.face[k] = 0;
    if (first + k < count_) {
      leaf.face[k] = items_[first + k].face;
      box = face_box(leaf.face[k]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      leaf.low[axis][k] = box.low[axis];
      leaf.high[axis][k] = box.high[axis];
      all.low[axis] = std::min(all.low[axis], leaf.low[axis][k]);
      all.high[axis] = std::max(all.high[axis], leaf.high[axis][k]);
    }
  }
  nodes_[r.node] = {all, r.first_leaf, 1};
  leaf_node_[r.first_leaf] = r.node;
}

void FaceTree::join_boxes(const Range& r) {
  const Box &a = nodes_[first_child(r).node].box, &b = nodes_[second_child(r).node].box;
  Node& node = nodes_[r.node];
  for (int axis = 0; axis < 3; ++axis) {
    node.box.low[axis] = std::min(a.low[axis], b.low[axis]);
    node.box.high[axis] = std::max(a.high[axis], b.high[axis]);
  }
  node.first_leaf = r.first_leaf;
  node.leaf_count = r.leaf_count;
}

// Recursion is as deep as the tree: log2 of the number of leaves.
void FaceTree::build_subtree(const Range& r) {
  if (r.leaf_count == 1) {
    make_leaf(r);
    return;
  }
  split(r);
  build_subtree(first_child(r));
  build_subtree(second_child(r));
  join_boxes(r);
}

void FaceTree::build(const double* xyz, const uint32_t* abc, const uint32_t* ids, size_t count,
                     const Executor& executor) {
  count_ = count;
  const size_t leaf_total = (count + kLeafFaces - 1) / kLeafFaces;
  items_.resize_uninitialized(count);
  leaves_.resize_uninitialized(leaf_total);
  leaf_node_.resize_uninitialized(leaf_total);
  nodes_.resize_uninitialized(leaf_total == 0 ? 0 : 2 * leaf_total - 1);
  if (count == 0) return;
  xyz_ = xyz;
  abc_ = abc;
  run_blocks(executor, count, kBlock, [&](size_t, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      Item& item = items_[i];
      item.face = ids[i];
      const Box box = face_box(ids[i]);
      for (int axis = 0; axis < 3; ++axis) item.centre[axis] = box.low[axis] + box.high[axis];
    }
  });
  // Levels of the top, then subtrees, then the boxes of the top from below.
  Vector<Vector<Range>> levels = {{{0, 0, static_cast<uint32_t>(leaf_total)}}};
  while (levels.back().size() < kSubtrees && levels.back().front().leaf_count > 4) {
    const Vector<Range>& level = levels.back();
    executor.run(level.size(), [&](size_t i) { split(level[i]); });
    Vector<Range> next;
    for (const Range& r : level) {
      next.push_back(first_child(r));
      next.push_back(second_child(r));
    }
    levels.push_back(std::move(next));
  }
  executor.run(levels.back().size(), [&](size_t i) { build_subtree(levels.back()[i]); });
  for (size_t level = levels.size() - 1; level-- > 0;) {
    for (const Range& r : levels[level]) join_boxes(r);
  }
}

}  // namespace plc
