#include "engine/guard/box_tree.h"

#include <array>
#include <bit>

namespace plc {
namespace {

Box3 all_lanes(const BoxLanes& b) {
  Box3 box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = *std::min_element(b.low[axis], b.low[axis] + BoxLanes::kLanes);
    box.high[axis] = *std::max_element(b.high[axis], b.high[axis] + BoxLanes::kLanes);
  }
  return box;
}

}  // namespace

BoxTree::Level& BoxTree::add_level() {
  if (levels_.size() == level_count_) levels_.emplace_back();
  return levels_[level_count_++];
}

void BoxTree::build_nodes(const Executor& executor) {
  do {
    Level& level = add_level();
    const Level& below = levels_[level_count_ - 2];
    const size_t children = below.boxes.size();
    level.resize(block_count(children, kLanes));
    run_blocks(executor, level.boxes.size(), kNodeBlock, [&](size_t, size_t begin, size_t end) {
      level.fill(begin, end, children, [&](size_t child) {
        return Face{all_lanes(below.boxes[child]), below.moved[child] != 0};
      });
    });
  } while (levels_[level_count_ - 1].boxes.size() > 1);
}

void BoxTree::set_still() {
  for (size_t level = 0; level < level_count_; ++level) {
    std::fill(levels_[level].moved.begin(), levels_[level].moved.end(), uint8_t{0});
  }
  set_.clear();
}

void BoxTree::set(uint32_t f, const Box3& box) {
  levels_[0].boxes[f / kLanes].set(f % kLanes, box);
  levels_[0].moved[f / kLanes] |= static_cast<uint8_t>(1U << (f % kLanes));
  set_.push_back(f / kLanes);
}

void BoxTree::update() {
  for (size_t level = 1; level < level_count_; ++level) {
    std::sort(set_.begin(), set_.end());
    set_.erase(std::unique(set_.begin(), set_.end()), set_.end());
    for (uint32_t& node : set_) {
      const uint32_t parent = node / kLanes, lane = node % kLanes;
      levels_[level].boxes[parent].set(lane, all_lanes(levels_[level - 1].boxes[node]));
      levels_[level].moved[parent] |= static_cast<uint8_t>(1U << lane);
      node = parent;
    }
  }
}

// Lists the nodes of leaves whose boxes overlap that of this one, itself and those after it.
void BoxTree::find_near(uint32_t node, Vector<uint32_t>& near) const {
  near.clear();
  if (level_count_ == 2) {
    near.push_back(node);
    return;
  }
  const Box3 box = levels_[2].boxes[node / kLanes].at(node % kLanes);
  const bool moved = levels_[1].moved[node] != 0;
  struct Visit {
    uint32_t level, node;
  };
  std::array<Visit, 16 * kLanes> stack;  // at most 7 of each level wait
  uint32_t depth = 0;
  stack[depth++] = {static_cast<uint32_t>(level_count_ - 1), 0};
  while (depth != 0) {
    const Visit at = stack[--depth];
    const Level& level = levels_[at.level];
    uint32_t hits = level.boxes[at.node].overlapping(box);
    if (!moved) hits &= level.moved[at.node];
    // Nodes before this one find the pair when it is their turn.
    const uint32_t own = node >> (3 * (at.level - 2));  // the child of this level that holds it
    if (own >= (at.node + 1) * kLanes) continue;
    if (own >= at.node * kLanes) hits &= ~((1U << (own - at.node * kLanes)) - 1);
    for (; hits != 0; hits &= hits - 1) {
      const uint32_t child = at.node * kLanes + static_cast<uint32_t>(std::countr_zero(hits));
      if (at.level == 2) {
        near.push_back(child);
      } else {
        stack[depth++] = {at.level - 1, child};
      }
    }
  }
}

}  // namespace plc
