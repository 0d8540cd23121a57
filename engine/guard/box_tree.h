// A tree of boxes over listed faces, of which some have moved: which pairs may meet.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "engine/base/blocks.h"
#include "kernels/box_lanes.h"
#include "kernels/face_pairs.h"
#include "kernels/simd.h"
#include "pyramid/buffer.h"
#include "pyramid/executor.h"
#include "pyramid/memory.h"

namespace plc {

// 8 children to a node, over the faces in the order in which they are numbered: boxes are tight
// where that follows a space-filling curve, and nothing has to be sorted. 27.6 bytes a face. Where
// exact/face_tree.h sorts, and serves any mesh, this is for asking in every step. Not thread-safe,
// but for pairs().
class BoxTree {
 public:
  struct Face {
    Box3 box;
    bool moved;
  };
  // face(f): the Face of each f < count. Buffers are kept from call to call. The same for any
  // executor.
  template <typename OfFace>
  void build(size_t count, const Executor& executor, const OfFace& face);

  // After set_still(), set() and update() those that were set alone have moved, and have these
  // boxes.
  void set_still();
  void set(uint32_t f, const Box3& box);
  void update();

  // Nodes of leaves: pairs() of all of them finds every pair.
  size_t nodes() const { return level_count_ == 0 ? 0 : levels_[1].boxes.size(); }
  struct Scratch {
    Vector<uint32_t> near;  // nodes of leaves
    Buffer<kernels::CandidatePair> pairs;
  };
  // visit(f, g), f < g, for faces in the leaves of this node and in the same or later leaves: those
  // pairs without a common corner, of which one has moved, whose boxes overlap (closed). corners:
  // three ids per face, with room_for() ids to read. The same for any `simd`.
  template <typename Visit>
  void pairs(SimdTarget simd, const uint32_t* corners, uint32_t node, Scratch& scratch,
             const Visit& visit) const;

  // Ids of the corners of so many faces in whole leaves.
  static size_t room_for(size_t faces) { return 3 * block_count(faces, kLanes) * kLanes; }

 private:
  static constexpr uint32_t kLanes = BoxLanes::kLanes;
  static constexpr size_t kNodeBlock = 128;  // nodes per task that are built
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  static constexpr Box3 kNothing{{kInfinity, kInfinity, kInfinity},
                                 {-kInfinity, -kInfinity, -kInfinity}};
  // Level 0: leaves, nodes of faces; level k: nodes of nodes of level k - 1. Two levels at least.
  struct Level {
    Buffer<BoxLanes> boxes;
    Buffer<uint8_t> moved;  // a bit per child: some face in it has

    void resize(size_t count) {
      boxes.resize_uninitialized(count);
      moved.resize_uninitialized(count);
    }
    // Nodes begin .. end - 1 of `children` children.
    template <typename Child>
    void fill(size_t begin, size_t end, size_t children, const Child& child) {
      for (size_t node = begin; node < end; ++node) {
        uint32_t bits = 0;
        for (uint32_t k = 0; k < kLanes; ++k) {
          const size_t c = node * kLanes + k;
          const Face face = c < children ? child(c) : Face{kNothing, false};
          boxes[node].set(k, face.box);
          bits |= static_cast<uint32_t>(face.moved) << k;
        }
        moved[node] = static_cast<uint8_t>(bits);
      }
    }
  };

  Level& add_level();
  void build_nodes(const Executor& executor);
  void find_near(uint32_t node, Vector<uint32_t>& near) const;

  Vector<Level> levels_;
  size_t level_count_ = 0;
  Vector<uint32_t> set_;  // nodes that are brought up to date
};

// ---- implementation -------------------------------------------------------------------------

template <typename OfFace>
void BoxTree::build(size_t count, const Executor& executor, const OfFace& face) {
  level_count_ = 0;
  if (count == 0) return;
  Level& leaves = add_level();
  leaves.resize(block_count(count, kLanes));
  run_blocks(executor, leaves.boxes.size(), kNodeBlock,
             [&](size_t, size_t begin, size_t end) { leaves.fill(begin, end, count, face); });
  build_nodes(executor);
}

template <typename Visit>
void BoxTree::pairs(SimdTarget simd, const uint32_t* corners, uint32_t node, Scratch& scratch,
                    const Visit& visit) const {
  const Level &leaves = levels_[0], &nodes = levels_[1];
  find_near(node, scratch.near);
  const size_t room = scratch.near.size() * kernels::kMostPairs;
  if (scratch.pairs.size() < room) scratch.pairs.resize_uninitialized(room);
  const kernels::FaceBoxes tree{corners, leaves.boxes.data(), leaves.moved.data(),
                                nodes.boxes.data(), nodes.moved.data()};
  const size_t end = std::min<size_t>((size_t{node} + 1) * kLanes, leaves.boxes.size());
  for (size_t leaf = size_t{node} * kLanes; leaf < end; ++leaf) {
    const size_t count =
        kernels::face_pairs(simd, tree, static_cast<uint32_t>(leaf), scratch.near.data(),
                            scratch.near.size(), scratch.pairs.data());
    for (size_t i = 0; i < count; ++i) visit(scratch.pairs[i].f, scratch.pairs[i].g);
  }
}

}  // namespace plc
