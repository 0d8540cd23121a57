#include "kernels/hash_entries.h"

#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

#include "kernels/ring.h"

namespace {

namespace kernels = plc::kernels;
using plc::SimdTarget;
using Quanta = std::array<int32_t, 3>;

plc::CoarsePlace place_of(const Quanta& q) {
  return plc::coarse_place(q[0], q[1], q[2]);
}

bool within(const Quanta& q, const Quanta& low, const Quanta& high) {
  bool inside = true;
  for (size_t k = 0; k < 3; ++k) inside &= low[k] <= q[k] && q[k] <= high[k];
  return inside;
}

class Dice {
 public:
  explicit Dice(uint32_t seed) : bits_(seed) {}
  int32_t from_to(int32_t low, int32_t high) {
    return low + static_cast<int32_t>(bits_() % static_cast<uint32_t>(high - low + 1));
  }
  Quanta quanta(int32_t low, int32_t high) {
    return {from_to(low, high), from_to(low, high), from_to(low, high)};
  }

 private:
  std::mt19937 bits_;
};

}  // namespace

TEST_CASE("coarse places tell what lies in a box exactly within a period, and never too little",
          "[kernels]") {
  Dice dice(5);
  int inside = 0, outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Quanta low = dice.quanta(-900, 900);
    Quanta high = low;
    for (int32_t& q : high) q += dice.from_to(0, 150);
    Quanta at = low;
    for (int32_t& q : at) q += dice.from_to(-20, 160);
    const plc::CoarseBox box = plc::coarse_box(low.data(), high.data());
    CHECK(plc::may_be_within(place_of(at), box) == within(at, low, high));
    (within(at, low, high) ? inside : outside) += 1;
    // A period further it cannot be told.
    Quanta far = at;
    far[static_cast<size_t>(i % 3)] += i % 2 == 0 ? plc::kPlacePeriod : -3 * plc::kPlacePeriod;
    CHECK(plc::may_be_within(place_of(far), box) == within(at, low, high));
  }
  CHECK(inside > 1000);
  CHECK(outside > 2000);
}

TEST_CASE("a box that is longer than a period holds all places along that axis", "[kernels]") {
  Dice dice(6);
  const Quanta low{-7, 10, 30}, high{-7 + plc::kPlacePeriod - 1, 5000, 40};
  const plc::CoarseBox box = plc::coarse_box(low.data(), high.data());
  for (int i = 0; i < 2000; ++i) {
    const Quanta at = dice.quanta(-2000, 2000);
    const int32_t z = (at[2] % plc::kPlacePeriod + plc::kPlacePeriod) % plc::kPlacePeriod;
    CHECK(plc::may_be_within(place_of(at), box) == (z >= 30 && z <= 40));
  }
}

TEST_CASE("entries of runs are filtered in order on every SIMD target", "[kernels]") {
  Dice dice(7);
  constexpr uint32_t kEntries = 1000;
  std::vector<uint32_t> ids(kEntries + plc::kRingLanes, 7);
  std::vector<plc::CoarsePlace> places(kEntries + plc::kRingLanes, 0);
  std::vector<Quanta> at;
  for (uint32_t i = 0; i < kEntries; ++i) {
    ids[i] = i * 31 % kEntries;
    at.push_back(dice.quanta(0, 300));
    places[i] = place_of(at[i]);
  }
  const Quanta low{40, 60, 0}, high{260, 250, 300};
  const plc::CoarseBox box = plc::coarse_box(low.data(), high.data());
  std::vector<kernels::EntryRun> runs;
  std::vector<uint32_t> wanted;
  uint32_t total = 0;
  for (const uint32_t length : {0U, 1U, 3U, 4U, 7U, 8U, 15U, 16U, 17U, 40U, 100U}) {
    const auto first =
        static_cast<uint32_t>(dice.from_to(0, static_cast<int32_t>(kEntries - length)));
    runs.push_back({first, first + length});
    total += length;
  }
  runs.push_back({kEntries - 5, kEntries});
  total += 5;
  for (const auto& run : runs) {
    for (uint32_t i = run.first; i < run.last; ++i) {
      if (within(at[i], low, high)) wanted.push_back(ids[i]);
    }
  }
  CHECK(wanted.size() > 50);
  CHECK(wanted.size() < total);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    std::vector<uint32_t> out(total + plc::kRingLanes);
    out.resize(kernels::entries_within(simd, ids.data(), places.data(), runs.data(), runs.size(),
                                       box, out.data()));
    CHECK(out == wanted);
    CHECK(kernels::entries_within(simd, ids.data(), places.data(), runs.data(), 0, box,
                                  out.data()) == 0);
  }
}
