#include "engine/spatial_hash.h"

#include <algorithm>
#include <bit>

#include "engine/constants.h"

namespace plc {

void SpatialHash::build(const Mesh& mesh, float cell, const Executor& executor) {
  inverse_cell_ = 1.0F / cell;
  const uint32_t n = mesh.slots();
  const uint32_t buckets = std::bit_ceil(std::max(n, 256U)) * 2;
  mask_ = buckets - 1;
  late_.clear();
  late_head_.resize_uninitialized(buckets);
  std::fill(late_head_.begin(), late_head_.end(), kEnd);
  bucket_of_.resize_uninitialized(n);
  executor.run((n + kGrain - 1) / kGrain, [&](size_t block) {
    const auto begin = static_cast<uint32_t>(block) * kGrain;
    for (uint32_t v = begin; v < std::min(begin + kGrain, n); ++v) {
      bucket_of_[v] = mesh.alive(v) ? bucket(mesh.at(v)) : kEnd;
    }
  });
  // A stable counting sort: by bucket, then by id.
  start_.resize_uninitialized(buckets + 1);
  std::fill(start_.begin(), start_.end(), 0U);
  for (uint32_t v = 0; v < n; ++v) {
    if (bucket_of_[v] != kEnd) ++start_[bucket_of_[v] + 1];
  }
  for (uint32_t b = 0; b < buckets; ++b) start_[b + 1] += start_[b];
  entries_.resize_uninitialized(start_[buckets]);
  for (uint32_t v = n; v-- > 0;) {
    if (bucket_of_[v] == kEnd) continue;
    const Packed& p = mesh.packed[v];
    entries_[--start_[bucket_of_[v] + 1]] = {p.x, p.y, p.z, v};
  }
  // Each start_[b + 1] now is the start of bucket b: shift back.
  for (uint32_t b = 0; b < buckets; ++b) start_[b] = start_[b + 1];
  start_[buckets] = static_cast<uint32_t>(entries_.size());
}

void SpatialHash::insert(uint32_t v, Vec3 p) {
  const uint32_t b = bucket(p);
  late_.push_back({{p.x, p.y, p.z, v}, late_head_[b]});
  late_head_[b] = static_cast<uint32_t>(late_.size() - 1);
}

}  // namespace plc
