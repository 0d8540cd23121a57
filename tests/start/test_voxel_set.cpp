#include "engine/start/voxel_set.h"

#include <catch2/catch.hpp>
#include <set>

#include "engine/base/schedule.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Voxel;
using plc::VoxelSet;

constexpr int32_t kDims[3] = {150, 61, 5};  // rows across words and blocks

size_t index_of(const Voxel& v) {
  const auto size = [](int32_t n) { return static_cast<size_t>(n); };
  return (size(v[2]) * size(kDims[1]) + size(v[1])) * size(kDims[0]) + size(v[0]);
}

// Some clusters and single voxels, with their indices.
std::set<size_t> fill(VoxelSet& set) {
  std::set<size_t> expected;
  samples::Random random(5);
  for (int i = 0; i < 400; ++i) {
    Voxel v{};
    for (size_t a = 0; a < 3; ++a) {
      v[a] = static_cast<int32_t>(random.integer(0, kDims[a] - 1));
    }
    for (int k = 0; k < 4 && v[0] < kDims[0]; ++k, ++v[0]) {
      set.insert(v);
      expected.insert(index_of(v));
    }
  }
  return expected;
}

std::vector<size_t> all_of(const VoxelSet& set) {
  std::vector<size_t> all;
  set.visit([&](const Voxel& v) { all.push_back(index_of(v)); });
  return all;
}

}  // namespace

TEST_CASE("a voxel set holds what was put in and visits it in scan order", "[voxel_set]") {
  VoxelSet set(kDims);
  CHECK(all_of(set).empty());
  const std::set<size_t> expected = fill(set);
  CHECK(all_of(set) == std::vector<size_t>(expected.begin(), expected.end()));
  for (int32_t z = 0; z < kDims[2]; ++z) {
    for (int32_t y = 0; y < kDims[1]; ++y) {
      for (int32_t x = 0; x < kDims[0]; ++x) {
        if (set.has({x, y, z}) != (expected.count(index_of({x, y, z})) == 1)) {
          FAIL(x << " " << y << " " << z);
        }
      }
    }
  }
}

TEST_CASE("rows of a voxel set are visited within their bounds", "[voxel_set]") {
  VoxelSet set(kDims);
  const std::set<size_t> expected = fill(set);
  const std::array<int32_t, 2> bounds[] = {{0, 150},   {0, 0},  {3, 149}, {64, 65},
                                           {149, 150}, {20, 5}, {0, -2}};
  for (int32_t y = 0; y < kDims[1]; ++y) {
    for (const auto& [first, end] : bounds) {
      std::vector<int32_t> got, want;
      set.visit_row(y, 2, first, end, [&](int32_t x) { got.push_back(x); });
      for (int32_t x = first; x < end; ++x) {
        if (expected.count(index_of({x, y, 2})) == 1) want.push_back(x);
      }
      CAPTURE(y, first, end);
      REQUIRE(got == want);
    }
  }
}

TEST_CASE("voxels that a visit erases are not visited", "[voxel_set]") {
  VoxelSet set(kDims);
  const std::set<size_t> expected = fill(set);
  size_t visits = 0;
  set.visit([&](const Voxel& v) {
    ++visits;
    set.erase(v);
    for (int32_t x = v[0] + 1; x < kDims[0]; ++x) set.erase({x, v[1], v[2]});
  });
  std::set<size_t> rows;
  for (const size_t i : expected) rows.insert(i / static_cast<size_t>(kDims[0]));
  CHECK(visits == rows.size());
  CHECK(all_of(set).empty());
}

TEST_CASE("a copy of a voxel set is its own, and flips come back", "[voxel_set]") {
  VoxelSet set(kDims);
  fill(set);
  const std::vector<size_t> before = all_of(set);
  VoxelSet copy(set);
  copy.visit([&](const Voxel& v) { copy.erase(v); });
  CHECK(all_of(set) == before);
  set.flip({1, 2, 3});
  CHECK(all_of(set) != before);
  set.flip({1, 2, 3});
  CHECK(all_of(set) == before);
  CHECK(VoxelSet(kDims).has_image());
  CHECK_FALSE(VoxelSet().has_image());
}

TEST_CASE("slices of a voxel set can be filled by different threads", "[voxel_set]") {
  VoxelSet set(kDims);
  const plc::Schedule schedule(3);
  schedule.run(static_cast<size_t>(kDims[2]), [&](size_t z) {
    for (int32_t y = 0; y < kDims[1]; ++y) {
      for (int32_t x = y % 3; x < kDims[0]; x += 3) set.insert({x, y, static_cast<int32_t>(z)});
    }
  });
  size_t count = 0;
  set.visit([&](const Voxel& v) {
    ++count;
    if (v[0] % 3 != v[1] % 3) FAIL(v[0] << " " << v[1]);
  });
  CHECK(count == static_cast<size_t>(kDims[2] * kDims[1] * 50));
}
