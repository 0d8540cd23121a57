#include "engine/guard/box_tree.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "pyramid/executor.h"

namespace {

using plc::Box3;
using plc::BoxTree;

bool overlap(const Box3& a, const Box3& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (a.low[axis] > b.high[axis] || b.low[axis] > a.high[axis]) return false;
  }
  return true;
}

using Pairs = std::multiset<std::pair<uint32_t, uint32_t>>;

// Small boxes anywhere, of faces with a corner in common now and then.
struct Listed {
  explicit Listed(size_t count) : moved(count), corners(BoxTree::room_for(count), 0) {
    std::uniform_int_distribution<uint32_t> id(0, static_cast<uint32_t>(count));
    for (size_t f = 0; f < count; ++f) {
      boxes.push_back(anywhere());
      moved[f] = f % 3 == 0;
      for (size_t k = 0; k < 3; ++k) corners[3 * f + k] = id(random);
    }
  }
  Box3 anywhere() {
    std::uniform_real_distribution<float> place(0, 10), size(0, 1);
    Box3 box{};
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = place(random);
      box.high[axis] = box.low[axis] + size(random);
    }
    return box;
  }
  bool share(size_t f, size_t g) const {
    for (size_t k = 0; k < 9; ++k) {
      if (corners[3 * f + k / 3] == corners[3 * g + k % 3]) return true;
    }
    return false;
  }
  Pairs expected() const {
    Pairs pairs;
    for (uint32_t f = 0; f < boxes.size(); ++f) {
      for (uint32_t g = f + 1; g < boxes.size(); ++g) {
        if ((moved[f] || moved[g]) && !share(f, g) && overlap(boxes[f], boxes[g])) {
          pairs.emplace(f, g);
        }
      }
    }
    return pairs;
  }

  std::mt19937 random{7};
  std::vector<Box3> boxes;
  std::vector<bool> moved;
  std::vector<uint32_t> corners;
};

Pairs found(const BoxTree& tree, const Listed& listed, plc::SimdTarget simd) {
  Pairs pairs;
  BoxTree::Scratch scratch;
  for (uint32_t node = 0; node < tree.nodes(); ++node) {
    tree.pairs(simd, listed.corners.data(), node, scratch,
               [&](uint32_t f, uint32_t g) { pairs.emplace(f, g); });
  }
  return pairs;
}

}  // namespace

TEST_CASE("every pair of boxes that overlap is found once, and again after some have moved",
          "[box_tree]") {
  BoxTree tree;  // its buffers are kept
  for (const size_t count : {0U, 1U, 8U, 65U, 600U, 5000U}) {
    INFO(count);
    Listed listed(count);
    tree.build(count, plc::SerialExecutor(), [&](size_t f) {
      return BoxTree::Face{listed.boxes[f], listed.moved[f]};
    });
    for (const plc::SimdTarget simd : plc::available_simd_targets()) {
      CHECK(found(tree, listed, simd) == listed.expected());
    }
    listed.moved.assign(count, false);
    tree.set_still();
    for (uint32_t f = 0; f < count; f += 50) {
      listed.moved[f] = true;
      listed.boxes[f] = listed.anywhere();
      tree.set(f, listed.boxes[f]);
    }
    tree.update();
    CHECK(found(tree, listed, plc::best_simd_target()) == listed.expected());
  }
}
