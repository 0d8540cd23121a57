#include "engine/base/team.h"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cfenv>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

namespace {

using plc::Team;

// Helpers of their own, joined when they are summoned again and at the end.
class Helpers {
 public:
  explicit Helpers(Team& team) : team_(team) {}
  ~Helpers() {
    team_.dismiss();
    for (auto& [slot, thread] : threads_) thread.join();
  }
  Team::Summon summon() {
    return [this](uint32_t slot) {
      ++summoned;
      last_slot = std::max(last_slot, slot);
      std::thread& helper = threads_[slot];
      if (helper.joinable()) helper.join();
      helper = std::thread([this, slot] { team_.serve(slot); });
    };
  }
  int summoned = 0;
  uint32_t last_slot = 0;

 private:
  Team& team_;
  std::map<uint32_t, std::thread> threads_;
};

void nobody_comes(uint32_t) {}

// The tasks that each thread has run, in order.
class Record {
 public:
  void add(size_t task) {
    const std::lock_guard<std::mutex> lock(guard_);
    tasks_[std::this_thread::get_id()].push_back(task);
  }
  size_t size() {
    const std::lock_guard<std::mutex> lock(guard_);
    size_t all = 0;
    for (const auto& [thread, tasks] : tasks_) all += tasks.size();
    return all;
  }
  const std::vector<size_t>& of(std::thread::id thread) { return tasks_[thread]; }

 private:
  std::mutex guard_;
  std::map<std::thread::id, std::vector<size_t>> tasks_;
};

}  // namespace

TEST_CASE("a team runs every task of every loop once", "[team]") {
  for (const uint32_t members : {1U, 2U, 3U, 8U}) {
    Team team(members);
    Helpers helpers(team);
    const Team::Summon summon = helpers.summon();
    for (size_t loop = 0; loop < 3000; ++loop) {
      const size_t tasks = loop % 40;
      std::vector<int> runs(tasks, 0);
      REQUIRE(team.run(
          tasks, members, [&](size_t i) { ++runs[i]; }, summon));
      REQUIRE(std::count(runs.begin(), runs.end(), 1) == static_cast<int>(tasks));
    }
    CHECK((helpers.summoned > 0) == (members > 1));
  }
}

TEST_CASE("a loop does not wait for helpers that do not come", "[team]") {
  Team team(3);
  int runs = 0;
  for (int loop = 0; loop < 3; ++loop) {
    REQUIRE(team.run(
        10, 3, [&](size_t) { ++runs; }, nobody_comes));
  }
  CHECK(runs == 30);
}

TEST_CASE("who comes when the loop has ended finds nothing to do, and leaves", "[team]") {
  Team team(2);
  int runs = 0;
  REQUIRE(team.run(
      10, 2, [&](size_t) { ++runs; }, nobody_comes));
  team.serve(1);
  CHECK(runs == 10);
}

TEST_CASE("a member begins with its share, and then helps with the others", "[team]") {
  Team team(2);
  Record record;
  const auto caller = std::this_thread::get_id();
  std::thread helper;
  // The helper is left all but the first task, which it would take, too, from a caller who is late.
  std::atomic<bool> begun{false};
  const auto body = [&](size_t i) {
    const bool calls = std::this_thread::get_id() == caller;
    if (calls) begun = true;
    while (!begun) std::this_thread::yield();
    record.add(i);
    while (calls && record.size() < 10) std::this_thread::yield();
  };
  std::thread::id helping;
  REQUIRE(team.run(10, 2, body, [&](uint32_t slot) {
    helper = std::thread([&team, slot] { team.serve(slot); });
    helping = helper.get_id();
  }));
  helper.join();
  CHECK(record.of(caller) == std::vector<size_t>{0});
  CHECK(record.of(helping) == std::vector<size_t>{5, 6, 7, 8, 9, 1, 2, 3, 4});
}

TEST_CASE("no more members than are wanted take part", "[team]") {
  Team team(8);
  Helpers helpers(team);
  const Team::Summon summon = helpers.summon();
  std::atomic<int> runs{0};
  REQUIRE(team.run(
      100, 3, [&](size_t) { ++runs; }, summon));
  CHECK(helpers.summoned == 2);
  REQUIRE(team.run(
      2, 8, [&](size_t) { ++runs; }, summon));
  CHECK(helpers.last_slot == 2);
  CHECK(runs == 102);
}

TEST_CASE("a team has one loop at a time", "[team]") {
  Team team(2);
  Helpers helpers(team);
  const Team::Summon summon = helpers.summon();
  std::atomic<int> refused{0}, runs{0};
  const auto inner = [&](size_t) { ++runs; };
  REQUIRE(team.run(
      4, 2, [&](size_t) { refused += team.run(4, 2, inner, summon) ? 0 : 1; }, summon));
  CHECK(refused == 4);
  CHECK(runs == 0);
  REQUIRE(team.run(4, 2, inner, summon));
  CHECK(runs == 4);
}

TEST_CASE("helpers leave when nothing comes, or when they are dismissed, and may come again",
          "[team]") {
  Team team(2);
  std::atomic<int> left{0}, runs{0};
  std::vector<std::thread> threads;
  const auto summon = [&](uint32_t slot) {
    threads.emplace_back([&, slot] {
      team.serve(slot);
      ++left;
    });
  };
  const auto loop = [&] {
    REQUIRE(team.run(
        4, 2, [&](size_t) { ++runs; }, summon));
  };
  loop();
  while (left == 0) std::this_thread::yield();
  loop();
  team.dismiss();
  while (left == 1) std::this_thread::yield();
  for (std::thread& t : threads) t.join();
  CHECK(runs == 8);
  CHECK(threads.size() == 2);
}

TEST_CASE("helpers compute with the arithmetic that results are defined by", "[team]") {
  Team team(2);
  std::atomic<bool> helped{false};
  int rounding = -1;
  std::thread helper;
  const auto caller = std::this_thread::get_id();
  const auto body = [&](size_t) {
    if (std::this_thread::get_id() == caller) {
      while (!helped) std::this_thread::yield();
    } else {
      rounding = std::fegetround();
      helped = true;
    }
  };
  REQUIRE(team.run(2, 2, body, [&](uint32_t slot) {
    helper = std::thread([&team, slot] {
      std::fesetround(FE_UPWARD);
      team.serve(slot);
    });
  }));
  helper.join();
  CHECK(rounding == FE_TONEAREST);
}
