#include "engine/detect/due_vertices.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "pyramid/memory.h"

namespace plc {

void DueVertices::list_due() {
  list(all_blocks(), nullptr, false);
}

void DueVertices::list_due(const Vector<uint32_t>& blocks, const VertexBytes& calm) {
  list(blocks, &calm, false);
}

void DueVertices::list_all() {
  list(all_blocks(), nullptr, true);
}

const Vector<uint32_t>& DueVertices::all_blocks() {
  blocks_.resize(mesh_.padded() / kRingLanes);
  std::iota(blocks_.begin(), blocks_.end(), 0U);
  return blocks_;
}

void DueVertices::list(const Vector<uint32_t>& blocks, const VertexBytes* calm, bool all) {
  constexpr uint8_t kRestless[kRingLanes] = {};
  lanes_.resize(blocks.size());
  first_due_.assign(block_count(blocks.size(), kTaskBlocks) + 1, 0);
  run_blocks(executor_, blocks.size(), kTaskBlocks, [&](size_t task, size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const uint32_t first = blocks[i] * kRingLanes;
      lanes_[i] = due_lanes(first, calm == nullptr ? kRestless : calm->data() + first, all);
      for (uint32_t k = 0; k < kRingLanes && mesh_.is_patch(); ++k) {
        if (mesh_.is_absent(first + k)) lanes_[i] &= static_cast<uint16_t>(~(1U << k));
      }
      first_due_[task + 1] += static_cast<uint32_t>(std::popcount(lanes_[i]));
    }
  });
  std::partial_sum(first_due_.begin(), first_due_.end(), first_due_.begin());
  due_.resize(first_due_.back());
  run_blocks(executor_, blocks.size(), kTaskBlocks, [&](size_t task, size_t begin, size_t end) {
    uint32_t* next = due_.data() + first_due_[task];
    for (size_t i = begin; i < end; ++i) {
      for (uint32_t lanes = lanes_[i]; lanes != 0; lanes &= lanes - 1) {
        const uint32_t v = blocks[i] * kRingLanes + static_cast<uint32_t>(std::countr_zero(lanes));
        mesh_.path[v] = 0;
        mesh_.resize(v);
        idle_[v] = 0;
        *next++ = v;
      }
    }
  });
}

// Of a block; counts the periods of the others.
uint16_t DueVertices::due_lanes(uint32_t first, const uint8_t* calm, bool all) {
  const float far = all ? 0 : kCheckPath * static_cast<float>(mesh_.delta);
  const Float4* const position = &mesh_.position[first];
  const float* const path = &mesh_.path[first];
  uint8_t* const idle = &idle_[first];
  const uint16_t* const valence = mesh_.rings().valence + first;
  int32_t due[kRingLanes];
  for (uint32_t k = 0; k < kRingLanes; ++k) {
    // Where the mesh is finer than delta, sooner.
    const float fine = std::min(1.0F, 1.0F + position[k].w);
    due[k] =
        static_cast<int32_t>(path[k] >= far * fine) | static_cast<int32_t>(idle[k] >= kCheckPeriod);
    const int32_t counts = static_cast<int32_t>(calm[k] < kCalmPeriod) & ~due[k];
    idle[k] = static_cast<uint8_t>(idle[k] + (counts & 1));
    due[k] &= static_cast<int32_t>(valence[k] != 0);
  }
  uint32_t lanes = 0;
  for (uint32_t k = 0; k < kRingLanes; ++k) lanes |= static_cast<uint32_t>(due[k]) << k;
  return static_cast<uint16_t>(lanes);
}

}  // namespace plc
