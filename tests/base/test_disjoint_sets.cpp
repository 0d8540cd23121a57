#include "engine/base/disjoint_sets.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <utility>
#include <vector>

#include "engine/base/blocks.h"
#include "engine/base/schedule.h"

TEST_CASE("the smallest member stands for a set, by however many threads numbers are joined",
          "[disjoint_sets]") {
  constexpr uint32_t kCount = 40000;
  std::mt19937 random(5);
  std::uniform_int_distribution<uint32_t> id(0, kCount - 1);
  std::vector<std::pair<uint32_t, uint32_t>> pairs(kCount * 6 / 10);
  for (auto& [a, b] : pairs) a = id(random), b = id(random);
  // The smallest member, handed on until nothing changes.
  std::vector<uint32_t> smallest(kCount);
  for (uint32_t i = 0; i < kCount; ++i) smallest[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : pairs) {
      const uint32_t least = std::min(smallest[a], smallest[b]);
      changed = changed || smallest[a] != least || smallest[b] != least;
      smallest[a] = smallest[b] = least;
    }
  }
  for (const int threads : {1, 4}) {
    plc::DisjointSets sets(kCount);
    plc::run_blocks(plc::Schedule(threads), pairs.size(), 64,
                    [&](size_t, size_t begin, size_t end) {
                      for (size_t i = begin; i < end; ++i)
                        sets.join(pairs[i].first, pairs[i].second);
                    });
    std::vector<uint32_t> found(kCount);
    for (uint32_t i = 0; i < kCount; ++i) found[i] = sets.find(i);
    CHECK(found == smallest);
  }
}
