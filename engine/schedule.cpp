#include "engine/schedule.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <chrono>
#include <optional>

namespace plc {

struct Schedule::Arena {
  explicit Arena(int threads) : tbb(threads) {
    // More threads than cores: oneTBB would warn on stderr and leave it at the cores. The control
    // is process-wide and the smallest one counts, so there is none where it is not needed.
    if (threads > oneapi::tbb::info::default_concurrency()) {
      limit.emplace(oneapi::tbb::global_control::max_allowed_parallelism,
                    static_cast<size_t>(threads));
    }
  }
  std::optional<oneapi::tbb::global_control> limit;
  oneapi::tbb::task_arena tbb;
};

Schedule::Schedule(int threads)
    : arena_(threads > 1 ? std::make_unique<Arena>(threads) : nullptr), threads_(threads) {}
Schedule::~Schedule() = default;

void Schedule::run(size_t tasks, const std::function<void(size_t)>& body) const {
  if (tasks <= 1 || arena_ == nullptr) {
    for (size_t i = 0; i < tasks; ++i) body(i);
    return;
  }
  arena_->tbb.execute(
      [&] { oneapi::tbb::parallel_for(size_t{0}, tasks, [&](size_t i) { body(i); }); });
}

namespace {

bool conflict(const Pass& a, const Pass& b) {
  return (a.writes & (b.reads | b.writes)) != 0 || (a.reads & b.writes) != 0;
}

// The passes from `begin` on, in the order of the table, that may run at the same time.
size_t wave_end(const std::vector<Pass>& passes, size_t begin) {
  size_t end = begin + 1;
  for (; end < passes.size(); ++end) {
    for (size_t i = begin; i < end; ++i) {
      if (conflict(passes[i], passes[end])) return end;
    }
  }
  return end;
}

std::string names(const std::vector<Pass>& passes, size_t begin, size_t end) {
  std::string all = passes[begin].name;
  for (size_t i = begin + 1; i < end; ++i) all.append(", ").append(passes[i].name);
  return all;
}

}  // namespace

// The graph of the table by its levels. Its passes are loops over all vertices and nearly a chain:
// nodes and edges built anew for every step would buy nothing over this.
void Schedule::run_passes(const std::vector<Pass>& passes, bool small, const PassEnd& after) const {
  const bool serial = small || arena_ == nullptr;
  std::vector<double> seconds(passes.size(), 0);
  const auto run = [&](size_t i) {
    const double start = now();
    passes[i].body();
    seconds[i] = now() - start;
  };
  const auto run_waves = [&] {
    for (size_t begin = 0, end = 0; begin < passes.size(); begin = end) {
      end = wave_end(passes, begin);
      if (serial || end - begin == 1) {
        for (size_t i = begin; i < end; ++i) run(i);
      } else {
        oneapi::tbb::parallel_for(begin, end, run, oneapi::tbb::simple_partitioner());
      }
      if (after) after(names(passes, begin, end));
    }
  };
  if (serial) {
    run_waves();
  } else {
    arena_->tbb.execute(run_waves);
  }
  for (size_t i = 0; i < passes.size(); ++i) *passes[i].seconds += seconds[i];
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace plc
