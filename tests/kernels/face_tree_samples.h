// Random boxes of faces in the two levels that kernels/face_pairs.h reads.
#pragma once
#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include "kernels/face_pairs.h"

namespace samples {

using plc::Box3;
using plc::BoxLanes;

// Faces in a cube of 10, with the corners of strips: successive faces share some.
struct FaceTreeSample {
  uint32_t faces;
  std::vector<Box3> box;
  std::vector<uint32_t> corners;
  std::vector<bool> present, moved;
  std::vector<BoxLanes> leaves, nodes;
  std::vector<uint8_t> leaf_moved, node_moved;

  FaceTreeSample(uint32_t count, uint32_t seed, uint32_t percent_present, uint32_t percent_moved)
      : faces(count), box(count), present(count), moved(count) {
    std::mt19937 bits(seed);
    const auto part = [&](uint32_t percent) { return bits() % 100 < percent; };
    // Steps of 1/8, so that boxes touch now and then.
    const auto step = [&](uint32_t steps) { return static_cast<float>(bits() % steps) / 8; };
    for (uint32_t f = 0; f < count; ++f) {
      for (int axis = 0; axis < 3; ++axis) {
        box[f].low[axis] = step(80);
        box[f].high[axis] = box[f].low[axis] + step(20);
      }
      for (uint32_t k = 0; k < 3; ++k) corners.push_back(f / 2 + k + bits() % 2);
      present[f] = part(percent_present);
      moved[f] = present[f] && part(percent_moved);
      if (!present[f]) box[f] = kNothing;
    }
    build();
  }
  uint32_t leaf_count() const { return static_cast<uint32_t>(leaves.size()); }
  uint32_t node_count() const { return static_cast<uint32_t>(nodes.size()); }
  plc::kernels::FaceBoxes view() const {
    return {corners.data(), leaves.data(), leaf_moved.data(), nodes.data(), node_moved.data()};
  }

 private:
  static constexpr uint32_t kLanes = BoxLanes::kLanes;
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  static constexpr Box3 kNothing{{kInfinity, kInfinity, kInfinity},
                                 {-kInfinity, -kInfinity, -kInfinity}};

  static Box3 around(const BoxLanes& lanes) {
    Box3 all = kNothing;
    for (uint32_t k = 0; k < kLanes; ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        all.low[axis] = std::min(all.low[axis], lanes.low[axis][k]);
        all.high[axis] = std::max(all.high[axis], lanes.high[axis][k]);
      }
    }
    return all;
  }
  // One level: boxes and flags of `count` children.
  template <typename BoxOf, typename Moved>
  static void level(uint32_t count, const BoxOf& box_of, const Moved& has_moved,
                    std::vector<BoxLanes>& boxes, std::vector<uint8_t>& moves) {
    const uint32_t records = (count + kLanes - 1) / kLanes;
    boxes.resize(records);
    moves.assign(records, 0);
    for (uint32_t i = 0; i < records * kLanes; ++i) {
      const uint32_t record = i / kLanes, lane = i % kLanes;
      boxes[record].set(lane, i < count ? box_of(i) : kNothing);
      if (i >= count) continue;
      moves[record] |= static_cast<uint8_t>((has_moved(i) ? 1U : 0U) << lane);
    }
  }
  void build() {
    level(
        faces, [&](uint32_t f) { return box[f]; }, [&](uint32_t f) { return moved[f]; }, leaves,
        leaf_moved);
    level(
        leaf_count(), [&](uint32_t l) { return around(leaves[l]); },
        [&](uint32_t l) { return leaf_moved[l] != 0; }, nodes, node_moved);
    corners.resize(size_t{3} * kLanes * leaf_count());
  }
};

}  // namespace samples
