#include "engine/mesh/neighbors.h"

#include <catch2/catch.hpp>
#include <utility>

#include "pyramid/memory.h"
#include "tests/samples/sample_volumes.h"

namespace {

using plc::Neighbors;

Neighbors counted(uint32_t size) {
  Neighbors n;
  for (uint32_t i = 0; i < size; ++i) n.push_back(100 + i);
  return n;
}

plc::Vector<uint32_t> listed(const Neighbors& n) {
  return {n.begin(), n.end()};
}

}  // namespace

TEST_CASE("neighbours keep their order up to any size", "[neighbors]") {
  for (const uint32_t size : {0U, 1U, 31U, 32U, 33U, 64U, 300U}) {
    const Neighbors n = counted(size);
    REQUIRE(n.size() == size);
    for (uint32_t i = 0; i < size; ++i) CHECK(n[i] == 100 + i);
    CHECK(n.end() - n.begin() == size);
  }
}

TEST_CASE("next and previous go around", "[neighbors]") {
  for (const uint32_t size : {3U, 32U, 40U}) {
    const Neighbors n = counted(size);
    CHECK(n.next(0) == 101);
    CHECK(n.next(size - 1) == 100);
    CHECK(n.previous(0) == 99 + size);
    CHECK(n.previous(1) == 100);
  }
}

TEST_CASE("a neighbour is found where it stands, others at the end", "[neighbors]") {
  const Neighbors n = counted(35);
  CHECK(n.find(100) == 0);
  CHECK(n.find(134) == 34);
  CHECK(n.find(7) == 35);
  CHECK(n.contains(134));
  CHECK_FALSE(n.contains(135));
  CHECK_FALSE(Neighbors().contains(0));
}

TEST_CASE("insertions and deletions at random agree with a vector across the inline size",
          "[neighbors]") {
  samples::Random random(4);
  Neighbors n;
  plc::Vector<uint32_t> expected;
  for (uint32_t step = 0; step < 4000; ++step) {
    const auto size = static_cast<int64_t>(expected.size());
    // Drifts between 0 and 80 and so crosses 32 often.
    const bool grow = size == 0 || (size < 80 && random.integer(0, 79) < 80 - size);
    const auto k = random.integer(0, grow ? size : size - 1);
    if (grow) {
      n.insert(static_cast<uint32_t>(k), step);
      expected.insert(expected.begin() + k, step);
    } else {
      n.erase(static_cast<uint32_t>(k));
      expected.erase(expected.begin() + k);
    }
    REQUIRE(listed(n) == expected);
  }
}

TEST_CASE("copies are independent of the original", "[neighbors]") {
  for (const uint32_t size : {5U, 50U}) {
    Neighbors n = counted(size);
    Neighbors copy = n;
    n[0] = 1;
    CHECK(copy[0] == 100);
    const Neighbors moved = std::move(copy);
    CHECK(listed(moved) == listed(counted(size)));
    n.clear();
    CHECK(n.size() == 0);
  }
}
