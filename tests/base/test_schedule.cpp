#include "engine/base/schedule.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace {

using plc::Pass;
using plc::Schedule;

constexpr int kThreads[] = {1, 2, 3, 8};

void pause(int milliseconds) {
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
}

// Threads that take part in a loop of `tasks` tasks that all wait for one another a while.
size_t threads_of_loop(const Schedule& schedule, size_t tasks) {
  std::mutex guard;
  std::set<std::thread::id> threads;
  schedule.run(tasks, [&](size_t) {
    {
      const std::lock_guard<std::mutex> lock(guard);
      threads.insert(std::this_thread::get_id());
    }
    pause(3);
  });
  return threads.size();
}

// A pass that writes down when it began and ended.
struct Span {
  int begin = -1, end = -1;
};
Pass traced(const char* name, uint32_t reads, uint32_t writes, double& seconds, Span& span,
            std::atomic<int>& clock) {
  return {name, reads, writes, &seconds, [&] {
            span.begin = clock++;
            pause(2);
            span.end = clock++;
          }};
}

}  // namespace

TEST_CASE("a loop runs every task once", "[schedule]") {
  for (const int threads : kThreads) {
    const Schedule schedule(threads);
    CHECK(schedule.threads() == threads);
    for (const size_t tasks : {size_t{0}, size_t{1}, size_t{2}, size_t{7}, size_t{1000}}) {
      std::vector<std::atomic<int>> runs(tasks);
      schedule.run(tasks, [&](size_t i) { ++runs[i]; });
      for (const auto& n : runs) CHECK(n == 1);
    }
  }
}

TEST_CASE("one thread or one task is the calling thread, in order", "[schedule]") {
  std::vector<size_t> order;
  const auto caller = std::this_thread::get_id();
  const auto body = [&](size_t i) {
    CHECK(std::this_thread::get_id() == caller);
    order.push_back(i);
  };
  Schedule(1).run(5, body);
  Schedule(8).run(1, body);
  CHECK(order == std::vector<size_t>{0, 1, 2, 3, 4, 0});
}

TEST_CASE("as many threads as asked for take part, even where there are fewer cores",
          "[schedule]") {
  const Schedule schedule(8);
  size_t most = 0;
  for (int attempt = 0; attempt < 200 && most < 8; ++attempt) {
    most = std::max(most, threads_of_loop(schedule, 64));
  }
  CHECK(most == 8);
}

TEST_CASE("loops may be nested", "[schedule]") {
  const Schedule schedule(3);
  std::atomic<int> runs{0};
  schedule.run(10, [&](size_t) { schedule.run(10, [&](size_t) { ++runs; }); });
  CHECK(runs == 100);
}

TEST_CASE("two schedules of different sizes live side by side", "[schedule]") {
  const Schedule large(8);
  const Schedule small(2);
  std::atomic<int> runs{0};
  std::thread other([&] { small.run(100, [&](size_t) { ++runs; }); });
  large.run(100, [&](size_t) { ++runs; });
  other.join();
  CHECK(runs == 200);
}

TEST_CASE("passes keep their order where one writes what another reads or writes", "[schedule]") {
  for (const bool small : {true, false}) {
    for (const int threads : kThreads) {
      const Schedule schedule(threads);
      std::atomic<int> clock{0};
      double seconds[2] = {0, 0};
      Span written, read, other, overwritten, last;
      const std::vector<Pass> table{
          traced("write", 0, plc::kNormals, seconds[0], written, clock),
          traced("read", plc::kNormals, plc::kStep, seconds[0], read, clock),
          traced("other", plc::kRings, plc::kRestLength, seconds[1], other, clock),
          traced("overwrite", plc::kRings, plc::kNormals, seconds[1], overwritten, clock),
          traced("last", plc::kNormals | plc::kStep | plc::kRestLength, 0, seconds[1], last,
                 clock)};
      CHECK(schedule.run_passes(table, small).ok());
      CAPTURE(threads, small);
      CHECK(clock == 10);
      CHECK(written.end < read.begin);
      CHECK(read.end < overwritten.begin);
      CHECK(overwritten.end < last.begin);
      CHECK(other.end < last.begin);
      CHECK(seconds[0] >= 0.004);
      CHECK(seconds[1] >= 0.006);
    }
  }
}

TEST_CASE("passes that touch nothing of each other run at the same time", "[schedule]") {
  const Schedule schedule(3);
  std::atomic<int> begun{0};
  bool met[2] = {false, false};
  double seconds = 0;
  // Each waits until the other has begun: on a loaded machine a thread may be long in coming.
  const auto meeting = [&](const char* name, uint32_t writes, bool& both) {
    return Pass{name, plc::kRings, writes, &seconds, [&begun, &both] {
                  ++begun;
                  for (const double start = plc::now(); begun < 2 && plc::now() < start + 60;) {
                    pause(1);
                  }
                  both = begun == 2;
                }};
  };
  const std::vector<Pass> table{meeting("one", plc::kNormals, met[0]),
                                meeting("two", plc::kRestLength, met[1])};
  CHECK(schedule.run_passes(table, false).ok());
  CHECK(met[0]);
  CHECK(met[1]);
}

TEST_CASE("who waits for passes to end is told the same for any threads, when none runs",
          "[schedule]") {
  for (const bool small : {true, false}) {
    for (const int threads : kThreads) {
      const Schedule schedule(threads);
      double seconds = 0;
      std::atomic<int> ended{0};
      const auto pass = [&](const char* name, uint32_t reads, uint32_t writes) {
        return Pass{name, reads, writes, &seconds, [&] {
                      pause(2);
                      ++ended;
                    }};
      };
      std::vector<std::string> told;
      std::vector<uint32_t> written;
      std::vector<int> count;
      const std::vector<Pass> table{pass("normals", 0, plc::kNormals),
                                    pass("rest length", 0, plc::kRestLength),
                                    pass("stage", plc::kNormals, plc::kStages)};
      const auto after = [&](const std::string& names, uint32_t writes) {
        told.push_back(names);
        written.push_back(writes);
        count.push_back(ended);
      };
      CHECK(schedule.run_passes(table, small, after).ok());
      CAPTURE(threads, small);
      CHECK(told == std::vector<std::string>{"normals, rest length", "stage"});
      CHECK(written == std::vector<uint32_t>{plc::kNormals | plc::kRestLength, plc::kStages});
      CHECK(count == std::vector<int>{2, 3});
    }
  }
}

TEST_CASE("small passes run on the calling thread", "[schedule]") {
  const Schedule schedule(3);
  double seconds = 0;
  std::thread::id thread;
  const auto body = [&] { thread = std::this_thread::get_id(); };
  const Pass pass{"pass", plc::kRings, plc::kNormals, &seconds, body};
  CHECK(schedule.run_passes({pass}, true).ok());
  CHECK(thread == std::this_thread::get_id());
}

TEST_CASE("an empty table is nothing to do", "[schedule]") {
  CHECK(Schedule(2).run_passes({}, false).ok());
  CHECK(Schedule(1).run_passes({}, true).ok());
}

TEST_CASE("a pass that fails ends the table, and its status is the table's", "[schedule]") {
  for (const int threads : kThreads) {
    const Schedule schedule(threads);
    double seconds = 0;
    std::vector<std::string> told;
    bool went_on = false;
    const auto fails = [] { return plc::Status{plc::ErrorCode::kInvalidData, "no"}; };
    const std::vector<Pass> table{{"first", 0, plc::kNormals, &seconds, [] {}},
                                  {"fails", plc::kNormals, plc::kStages, &seconds, fails},
                                  {"after", plc::kStages, 0, &seconds, [&] { went_on = true; }}};
    const auto after = [&](const std::string& names, uint32_t) { told.push_back(names); };
    CHECK(schedule.run_passes(table, false, after).message() == "no");
    CHECK_FALSE(went_on);
    CHECK(told == std::vector<std::string>{"first"});
  }
}

TEST_CASE("the clock does not go back", "[schedule]") {
  const double before = plc::now();
  pause(2);
  CHECK(plc::now() >= before + 0.002);
}
