#include "engine/spatial_hash.h"

#include <algorithm>
#include <bit>

#include "engine/blocks.h"
#include "engine/constants.h"
#include "engine/four.h"
#include "pyramid/memory.h"

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
  const uint32_t b = bucket(p);
  if (!has_entry(b, v)) enter(v, b);
}

void SpatialHash::insert(const Mesh& mesh, const Vector<uint32_t>& ids, const Executor& executor) {
  constexpr size_t kTask = 512;
  const size_t tasks = block_count(ids.size(), kTask);
  missing_.resize(std::max(missing_.size(), tasks));
  run_blocks(executor, ids.size(), kTask, [&](size_t task, size_t begin, size_t end) {
    missing_[task].clear();
    for (size_t i = begin; i < end; ++i) {
      if (!has_entry(bucket(mesh.at(ids[i])), ids[i])) missing_[task].push_back(ids[i]);
    }
  });
  for (size_t task = 0; task < tasks; ++task) {
    for (const uint32_t v : missing_[task]) enter(v, bucket(mesh.at(v)));
  }
}

void SpatialHash::enter(uint32_t v, uint32_t b) {
  const uint32_t list = b >> kLateShift;
  late_.push_back({v, late_head_[list]});
  late_head_[list] = static_cast<uint32_t>(late_.size() - 1);
}

bool SpatialHash::has_entry(uint32_t b, uint32_t v) const {
  const uint32_t* const end = entries_.data() + start_[b + 1];
  if (std::find(entries_.data() + start_[b], end, v) != end) return true;
  uint32_t i = late_head_[b >> kLateShift];
  while (i != kEnd && late_[i].id != v) i = late_[i].next;
  return i != kEnd;
}

void SpatialHash::collect(const Mesh& mesh, Vec3 low, Vec3 high, Collected& out) const {
  // Each step asks for the memory of the next one for all rows before it reads any.
  out.runs.clear();
  visit_rows(low, high, [&](uint32_t first, uint32_t run) {
    visit_runs(first, run, [&](uint32_t b, uint32_t last) {
      __builtin_prefetch(&start_[b]);
      out.runs.push_back({b, last});
    });
  });
  size_t count = 0;
  for (const Run& r : out.runs) {
    __builtin_prefetch(&entries_[start_[r.first]]);
    count += start_[r.last + 1] - start_[r.first];
  }
  out.found.resize_uninitialized(count);
  // Nothing that the loops write is among what they read: by pointers of their own.
  const Packed* const packed = mesh.packed.data();
  uint32_t* found = out.found.data();
  count = 0;
  for (const Run& r : out.runs) {
    const uint32_t* const end = entries_.data() + start_[r.last + 1];
    for (const uint32_t* e = entries_.data() + start_[r.first]; e != end; ++e) {
      __builtin_prefetch(packed + *e);
      found[count++] = *e;
    }
    if (late_.empty()) continue;
    for (uint32_t l = r.first >> kLateShift; l <= r.last >> kLateShift; ++l) {
      for (uint32_t i = late_head_[l]; i != kEnd; i = late_[i].next) {
        out.found.resize_uninitialized(out.found.size() + 1);
        found = out.found.data();
        found[count++] = late_[i].id;
      }
    }
  }
  const Four from{low.x, low.y, low.z, 0}, to{high.x, high.y, high.z, 0};
  out.ids.resize_uninitialized(out.found.size());
  uint32_t* within = out.ids.data();
  // Without branches: whether a vertex lies within is as good as random.
  for (const uint32_t* f = found; f != found + count; ++f) {
    const Four at = load_four(packed[*f]);
    *within = *f;
    within += static_cast<size_t>(overlap_four(at, at, from, to));
  }
  out.ids.resize_uninitialized(static_cast<size_t>(within - out.ids.data()));
}

}  // namespace plc
