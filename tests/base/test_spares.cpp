#include "engine/base/spares.h"

#include <catch2/catch.hpp>
#include <set>
#include <thread>
#include <vector>

namespace {

struct Scratch {
  std::vector<int> values;
};

}  // namespace

TEST_CASE("what is lent at the same time differs, and comes again with what it holds", "[spares]") {
  plc::Spares<Scratch> spares;
  std::set<const Scratch*> lent;
  {
    const auto a = spares.lend();
    const auto b = spares.lend();
    lent = {&*a, &*b};
    CHECK(lent.size() == 2);
    (*a).values.resize(100);
    (*b).values.resize(100);
  }
  const auto a = spares.lend();
  const auto b = spares.lend();
  CHECK(std::set<const Scratch*>{&*a, &*b} == lent);
  CHECK((*a).values.size() == 100);
  CHECK((*b).values.size() == 100);
  const auto c = spares.lend();
  CHECK(lent.count(&*c) == 0);
}

TEST_CASE("threads never work with the same spare", "[spares]") {
  plc::Spares<Scratch> spares;
  std::vector<std::thread> threads;
  bool alone[4] = {true, true, true, true};
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&spares, &alone, t] {
      for (int i = 0; i < 2000; ++i) {
        const auto mine = spares.lend();
        (*mine).values.assign(8, t);
        for (const int value : (*mine).values) alone[t] = alone[t] && value == t;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const bool was_alone : alone) CHECK(was_alone);
}
