#include "engine/start/small_parts.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "engine/base/blocks.h"
#include "engine/base/disjoint_sets.h"
#include "engine/base/marks.h"
#include "pyramid/memory.h"

namespace plc {
namespace {

constexpr size_t kBlock = 16384;  // vertices or faces of a task
constexpr uint32_t kNone = ~0U;

// What of a surface is too small to be kept.
class SmallParts {
 public:
  SmallParts(const Crossings& all, const Buffer<int32_t>& points, const Executor& executor)
      : points_(points),
        executor_(executor),
        components_(joined_faces(all, points.size(), executor)),
        enclosed_(points.size()) {
    run_blocks(executor_, points.size(), kBlock, [&](size_t, size_t begin, size_t end) {
      uint32_t of = 0;
      int64_t sum = 0;  // of successive vertices of the same component
      for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
        const uint32_t component = components_.find(v);
        if (component != of && sum != 0) add_to_mark(enclosed_[of], sum);
        if (component != of) of = component, sum = 0;
        sum += points_[v];
      }
      if (sum != 0) add_to_mark(enclosed_[of], sum);
    });
    // Of a cavity it is negative.
    const auto by_size = [](int64_t a, int64_t b) { return std::abs(a) < std::abs(b); };
    most_ = std::abs(*std::max_element(enclosed_.begin(), enclosed_.end(), by_size));
  }

  // By vertex, what it is in what is kept: how many were kept before it, or kNone.
  Buffer<uint32_t> numbers(int64_t least) {
    least = std::min(least, most_);
    const auto is_kept = [&](uint32_t v) {
      return std::abs(enclosed_[components_.find(v)]) >= least;
    };
    Buffer<uint32_t> number;
    number.resize_uninitialized(points_.size());
    Vector<uint32_t> first(block_count(points_.size(), kBlock) + 1, 0);
    run_blocks(executor_, points_.size(), kBlock, [&](size_t block, size_t begin, size_t end) {
      uint32_t kept = 0;
      for (auto v = static_cast<uint32_t>(begin); v < end; ++v) {
        number[v] = is_kept(v) ? kept++ : kNone;
      }
      first[block + 1] = kept;
    });
    for (size_t block = 1; block < first.size(); ++block) first[block] += first[block - 1];
    run_blocks(executor_, points_.size(), kBlock, [&](size_t block, size_t begin, size_t end) {
      for (size_t v = begin; v < end; ++v) number[v] += number[v] == kNone ? 0 : first[block];
    });
    return number;
  }

 private:
  static DisjointSets joined_faces(const Crossings& all, size_t vertices,
                                   const Executor& executor) {
    DisjointSets sets(vertices);
    run_blocks(executor, all.abc.size() / 3, kBlock, [&](size_t, size_t begin, size_t end) {
      for (size_t c = 3 * begin; c < 3 * end; c += 3) {
        sets.join(all.abc[c], all.abc[c + 1]);
        sets.join(all.abc[c], all.abc[c + 2]);
      }
    });
    return sets;
  }

  const Buffer<int32_t>& points_;
  const Executor& executor_;
  DisjointSets components_;
  Buffer<int64_t> enclosed_;  // by what stands for the component
  int64_t most_ = 0;
};

// Leaves triples out of `values`: keep(triple) tells which stay, and may change them.
template <typename T, typename Keep>
void keep_triples(const Executor& executor, const Keep& keep, Buffer<T>& values) {
  const size_t count = values.size() / 3;
  Vector<size_t> kept(block_count(count, kBlock));
  run_blocks(executor, count, kBlock, [&](size_t block, size_t begin, size_t end) {
    T* to = values.data() + 3 * begin;
    for (size_t i = begin; i < end; ++i) {
      T* from = values.data() + 3 * i;
      if (!keep(i, from)) continue;
      std::copy(from, from + 3, to);
      to += 3;
    }
    kept[block] = static_cast<size_t>(to - values.data()) - 3 * begin;
  });
  size_t used = 0;
  for (size_t block = 0; block < kept.size(); ++block) {
    std::memmove(values.data() + used, values.data() + 3 * block * kBlock, kept[block] * sizeof(T));
    used += kept[block];
  }
  values.resize(used);
}

}  // namespace

void leave_out_small_parts(const Buffer<int32_t>& points, int64_t least, const Executor& executor,
                           Crossings& all) {
  const Buffer<uint32_t> number = SmallParts(all, points, executor).numbers(least);
  keep_triples(
      executor,
      [&](size_t, uint32_t* abc) {
        for (size_t k = 0; k < 3; ++k) abc[k] = number[abc[k]];
        return abc[0] != kNone;
      },
      all.abc);
  keep_triples(
      executor, [&](size_t v, const float*) { return number[v] != kNone; }, all.xyz);
}

}  // namespace plc
