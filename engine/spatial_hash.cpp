#include "engine/spatial_hash.h"

#include <algorithm>
#include <bit>

#include "engine/blocks.h"
#include "engine/constants.h"

namespace plc {

namespace {

// Buckets are sorted in this many parts, each by itself.
constexpr uint32_t kParts = 16;
constexpr size_t kBlock = 4096;  // vertices per task

}  // namespace

void SpatialHash::build(const Mesh& mesh, float cell, const Executor& executor, float slack) {
  inverse_cell_ = 1.0F / cell;
  slack_ = slack;
  const uint32_t n = mesh.slots();
  const uint32_t buckets = std::bit_ceil(std::max(n, 256U));
  const auto part_shift = static_cast<uint32_t>(std::countr_zero(buckets / kParts));
  mask_ = buckets - 1;
  late_.clear();
  late_head_.resize_uninitialized(buckets >> kLateShift);
  std::fill(late_head_.begin(), late_head_.end(), kEnd);
  // A stable counting sort: by bucket, then by id. First by parts: how many of each block of
  // vertices lie in each part ...
  const size_t blocks = block_count(n, kBlock);
  part_start_.resize_uninitialized(blocks * kParts);
  run_blocks(executor, n, kBlock, [&](size_t block, size_t begin, size_t end) {
    uint32_t count[kParts] = {};
    for (size_t i = begin; i < end; ++i) {
      const auto v = static_cast<uint32_t>(i);
      if (mesh.alive(v)) ++count[bucket(mesh.at(v)) >> part_shift];
    }
    std::copy(count, count + kParts, part_start_.data() + block * kParts);
  });
  uint32_t total = 0;
  uint32_t first[kParts + 1];
  for (uint32_t part = 0; part < kParts; ++part) {
    first[part] = total;
    for (size_t block = 0; block < blocks; ++block) {
      uint32_t& here = part_start_[block * kParts + part];
      const uint32_t count = here;
      here = total;
      total += count;
    }
  }
  first[kParts] = total;
  placed_.resize_uninitialized(total);
  run_blocks(executor, n, kBlock, [&](size_t block, size_t begin, size_t end) {
    uint32_t* next = part_start_.data() + block * kParts;
    for (size_t i = begin; i < end; ++i) {
      const auto v = static_cast<uint32_t>(i);
      if (!mesh.alive(v)) continue;
      const uint32_t b = bucket(mesh.at(v));
      placed_[next[b >> part_shift]++] = {v, b};
    }
  });
  // ... then each part by buckets.
  start_.resize_uninitialized(size_t{buckets} + 1);
  start_[buckets] = total;
  entries_.resize_uninitialized(total);
  executor.run(kParts, [&](size_t part) {
    uint32_t* const begin = start_.data() + (part << part_shift);
    uint32_t* const end = begin + (size_t{1} << part_shift);
    const Placed* const from = placed_.data() + first[part];
    const Placed* const to = placed_.data() + first[part + 1];
    std::fill(begin, end, 0U);
    for (const Placed* p = from; p != to; ++p) ++start_[p->bucket];
    uint32_t next = first[part + 1];
    for (uint32_t* s = end; s-- != begin;) *s = next -= *s;
    // Backwards from the ends would need them: the starts move up and are moved back.
    for (const Placed* p = from; p != to; ++p) entries_[start_[p->bucket]++] = p->id;
    for (uint32_t* s = end; --s != begin;) *s = s[-1];
    *begin = first[part];
  });
}

void SpatialHash::insert(uint32_t v, Vec3 p) {
  const uint32_t list = bucket(p) >> kLateShift;
  late_.push_back({v, late_head_[list]});
  late_head_[list] = static_cast<uint32_t>(late_.size() - 1);
}

}  // namespace plc
