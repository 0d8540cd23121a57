// What it takes to share out loops: 100 of 8 tasks of 5 us each on all cores, with serial code of
// so many us before each, which is not counted. "team" is what the engine does
// (engine/base/team.h), "onetbb" the same by parallel_for in an arena of oneTBB.
#include <benchmark/benchmark.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <functional>
#include <thread>

#include "engine/base/schedule.h"

namespace {

constexpr int kLoops = 100;
constexpr size_t kTasks = 8;
using Loop = std::function<void(const std::function<void(size_t)>& body)>;

void busy(double seconds) {
  for (const double start = plc::now(); plc::now() < start + seconds;) {
  }
}

void measure(benchmark::State& state, const Loop& loop) {
  const auto between = static_cast<double>(state.range(0)) * 1e-6;
  for ([[maybe_unused]] auto _ : state) {
    std::array<int, kTasks> runs{};
    double seconds = 0;
    for (int i = 0; i < kLoops; ++i) {
      busy(between);
      const double start = plc::now();
      loop([&](size_t task) {
        busy(5e-6);
        ++runs[task];
      });
      seconds += plc::now() - start;
    }
    state.SetIterationTime(seconds);
    if (std::count(runs.begin(), runs.end(), kLoops) != kTasks) {
      state.SkipWithError("a task was not run once in each loop");
    }
  }
}

int cores() {
  return static_cast<int>(std::thread::hardware_concurrency());
}

void team(benchmark::State& state) {
  const plc::Schedule schedule(cores());
  measure(state, [&](const auto& body) { schedule.run(kTasks, body); });
}

void onetbb(benchmark::State& state) {
  oneapi::tbb::task_arena arena(cores());
  measure(state, [&](const auto& body) {
    arena.execute([&] { oneapi::tbb::parallel_for(size_t{0}, kTasks, body); });
  });
}

BENCHMARK(team)->Arg(0)->Arg(50)->Arg(300)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK(onetbb)->Arg(0)->Arg(50)->Arg(300)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
