#include "engine/detect/spatial_hash.h"

#include <algorithm>
#include <bit>
#include <cassert>

#include "engine/base/blocks.h"
#include "engine/base/constants.h"
#include "engine/base/four.h"
#include "kernels/prefetch.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// Buckets are sorted in this many parts, each by itself.
constexpr uint32_t kParts = 16;
constexpr size_t kBlock = 1024;  // vertices per task

}  // namespace

void SpatialHash::build(const Mesh& mesh, float cell, const Executor& executor, float slack) {
  assert(cell > 0 && slack >= 0);
  inverse_quantum_ = static_cast<float>(1 << kQuantaShift) / cell;
  slack_ = slack;
  const uint32_t n = mesh.slots();
  const Float4* const position = mesh.position.data();
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
      if (mesh.alive(v) && !mesh.is_absent(v))
        ++count[bucket(quanta(load_four(position[v]))) >> part_shift];
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
  // Kernels read whole vectors.
  for (Buffer<uint32_t>* stream : {&entries_, &places_}) {
    stream->resize_uninitialized(size_t{total} + kRingLanes);
    std::fill(stream->end() - kRingLanes, stream->end(), 0U);
  }
  run_blocks(executor, n, kBlock, [&](size_t block, size_t begin, size_t end) {
    uint32_t* next = part_start_.data() + block * kParts;
    for (size_t i = begin; i < end; ++i) {
      const auto v = static_cast<uint32_t>(i);
      if (!mesh.alive(v) || mesh.is_absent(v)) continue;
      const FourInts q = quanta(load_four(position[v]));
      const uint32_t entry = next[bucket(q) >> part_shift]++;
      entries_[entry] = v;
      places_[entry] = coarse_place(q[0], q[1], q[2]);
    }
  });
  // ... then each part by buckets.
  start_.resize_uninitialized(size_t{buckets} + 1);
  start_[buckets] = total;
  executor.run(kParts, [&](size_t part) {
    uint32_t* const begin = start_.data() + (part << part_shift);
    uint32_t* const end = begin + (size_t{1} << part_shift);
    std::fill(begin, end, 0U);
    struct Placed {
      uint32_t id, bucket;
      CoarsePlace place;
    };
    Buffer<Placed> placed;
    placed.resize_uninitialized(first[part + 1] - first[part]);
    for (uint32_t i = 0; i < placed.size(); ++i) {
      const uint32_t entry = first[part] + i, v = entries_[entry];
      placed[i] = {v, bucket(quanta(load_four(position[v]))), places_[entry]};
      ++start_[placed[i].bucket];
    }
    uint32_t next = first[part + 1];
    for (uint32_t* s = end; s-- != begin;) *s = next -= *s;
    // Backwards from the ends would need them: the starts move up and are moved back.
    for (const Placed& p : placed) {
      const uint32_t entry = start_[p.bucket]++;
      entries_[entry] = p.id;
      places_[entry] = p.place;
    }
    for (uint32_t* s = end; --s != begin;) *s = s[-1];
    *begin = first[part];
  });
}

void SpatialHash::insert(uint32_t v, Vec3 p) {
  assert(!late_head_.empty());  // it has been built
  const FourInts q = quanta(p);
  if (!refresh(v, q)) enter(v, bucket(q));
}

void SpatialHash::insert(const Mesh& mesh, const Vector<uint32_t>& ids, const Executor& executor) {
  constexpr size_t kTask = 128;
  const size_t tasks = block_count(ids.size(), kTask);
  missing_.resize(std::max(missing_.size(), tasks));
  run_blocks(executor, ids.size(), kTask, [&](size_t task, size_t begin, size_t end) {
    missing_[task].clear();
    for (size_t i = begin; i < end; ++i) {
      if (!refresh(ids[i], quanta(mesh.at(ids[i])))) missing_[task].push_back(ids[i]);
    }
  });
  for (size_t task = 0; task < tasks; ++task) {
    for (const uint32_t v : missing_[task]) enter(v, bucket(quanta(mesh.at(v))));
  }
}

void SpatialHash::enter(uint32_t v, uint32_t b) {
  const uint32_t list = b >> kLateShift;
  late_.push_back({v, late_head_[list]});
  late_head_[list] = static_cast<uint32_t>(late_.size() - 1);
}

bool SpatialHash::refresh(uint32_t v, FourInts q) {
  const uint32_t b = bucket(q);
  uint32_t entry = start_[b];
  while (entry != start_[b + 1] && entries_[entry] != v) ++entry;
  if (entry != start_[b + 1]) {
    places_[entry] = coarse_place(q[0], q[1], q[2]);
    return true;
  }
  uint32_t i = late_head_[b >> kLateShift];
  while (i != kEnd && late_[i].id != v) i = late_[i].next;
  return i != kEnd;
}

void SpatialHash::collect(const Mesh& mesh, Vec3 low, Vec3 high, Collected& out) const {
  // Each step asks for the memory of the next one for all rows before it reads any.
  const Reach reached = reach(low, high);
  out.runs.clear();
  visit_rows(reached, [&](uint32_t first, uint32_t run) {
    visit_runs(first, run, [&](uint32_t b, uint32_t last) {
      prefetch_near(&start_[b]);
      out.runs.push_back({b, last});
    });
  });
  uint32_t count = 0;
  out.entries.clear();
  for (const Run& r : out.runs) {
    const kernels::EntryRun run{start_[r.first], start_[r.last + 1]};
    prefetch_near(&entries_[run.first]);
    prefetch_near(&places_[run.first]);
    count += run.last - run.first;
    out.entries.push_back(run);
  }
  out.found.resize_uninitialized(size_t{count} + kRingLanes);
  count = kernels::entries_within(simd_, entries_.data(), places_.data(), out.entries.data(),
                                  out.entries.size(), reached.box(), out.found.data());
  out.found.resize_uninitialized(count);
  if (!late_.empty()) {
    for (const Run& r : out.runs) {
      visit_late(r.first, r.last, [&](uint32_t v) { out.found.push_back(v); });
    }
  }
  // Nothing that the loops write is among what they read: by pointers of their own.
  const Float4* const position = mesh.position.data();
  const uint32_t* const found = out.found.data();
  const uint32_t* const end = found + out.found.size();
  for (const uint32_t* f = found; f != end; ++f) prefetch_near(position + *f);
  const Four from{low.x, low.y, low.z, 0}, to{high.x, high.y, high.z, 0};
  out.ids.resize_uninitialized(out.found.size());
  uint32_t* within = out.ids.data();
  // Without branches: whether a vertex lies within is as good as random.
  for (const uint32_t* f = found; f != end; ++f) {
    const Four at = load_four(position[*f]);
    *within = *f;
    within += static_cast<size_t>(overlap_four(at, at, from, to));
  }
  out.ids.resize_uninitialized(static_cast<size_t>(within - out.ids.data()));
}

}  // namespace plc
