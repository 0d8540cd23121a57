#include "engine/schedule.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>

#include "engine/float_environment.h"
#include "engine/task_threads.h"
#include "pyramid/memory.h"

#if defined(__SANITIZE_THREAD__)
#define PLC_TASK_THREADS 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define PLC_TASK_THREADS 1
#endif
#endif
#ifndef PLC_TASK_THREADS
#define PLC_TASK_THREADS 0
#endif

namespace plc {

namespace {

// What the tasks of a loop throw: not through the host's threads.
class FirstException {
 public:
  void take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!first_) first_ = std::current_exception();
  }
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr first_;
};

int default_threads() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

struct Schedule::Arena {
  explicit Arena(int threads) : tbb(threads) {}
  oneapi::tbb::task_arena tbb;
};

Schedule::Schedule(const Threads& threads) : threads_(threads) {
  if (threads.parallel_for != nullptr || PLC_TASK_THREADS != 0) return;
  // More than oneTBB has for the process it does not give, and would say so on stderr; how many it
  // has is the host's to control.
  using Control = oneapi::tbb::global_control;
  const size_t most = Control::active_value(Control::max_allowed_parallelism);
  threads_.count = static_cast<int>(std::min(static_cast<size_t>(threads.count), most));
  if (threads_.count > 1) arena_ = std::make_unique<Arena>(threads_.count);
}
Schedule::~Schedule() = default;

int Schedule::threads() const {
  if (threads_.parallel_for != nullptr) return 0;
  if (threads_.count != 0) return threads_.count;
  return PLC_TASK_THREADS != 0 ? default_threads()
                               : oneapi::tbb::this_task_arena::max_concurrency();
}

void Schedule::run(size_t tasks, const std::function<void(size_t)>& body) const {
  if (tasks <= 1 || threads() == 1) {
    for (size_t i = 0; i < tasks; ++i) body(i);
    return;
  }
  Memory& memory = Memory::current();
  FirstException exception;
  run_parallel(tasks, [&](size_t i) {
    const MemoryScope scope(memory);
    try {
      body(i);
    } catch (...) {
      exception.take();
    }
  });
  exception.rethrow();
}

void Schedule::run_parallel(size_t tasks, const std::function<void(size_t)>& body) const {
  if (threads_.parallel_for != nullptr) {
    const auto task = [](size_t i, void* data) {
      const FloatEnvironment environment;
      (*static_cast<const std::function<void(size_t)>*>(data))(i);
    };
    threads_.parallel_for(tasks, task, const_cast<std::function<void(size_t)>*>(&body),
                          threads_.user);
    return;
  }
  if (PLC_TASK_THREADS != 0) return run_on_task_threads(threads(), tasks, body);
  // Of no group of the caller's: that one may be cancelled, and its loops then do nothing. Tasks
  // compute as this thread does.
  using Group = oneapi::tbb::task_group_context;
  Group group(Group::isolated, Group::default_traits | Group::fp_settings);
  const auto loop = [&] {
    oneapi::tbb::parallel_for(
        size_t{0}, tasks, [&](size_t i) { body(i); }, group);
  };
  if (arena_ != nullptr) {
    arena_->tbb.execute(loop);
  } else {
    // A thread that waits for the loop takes no other work of the host's meanwhile, which might
    // come back to this context.
    oneapi::tbb::this_task_arena::isolate(loop);
  }
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
// nodes and edges built anew for every step would buy nothing over this. A host's threads are not
// asked for loops within loops: passes then run in order.
void Schedule::run_passes(const std::vector<Pass>& passes, bool small, const PassEnd& after) const {
  const bool in_order = small || threads() == 1 || threads_.parallel_for != nullptr;
  std::vector<double> seconds(passes.size(), 0);
  const auto run_pass = [&](size_t i) {
    const double start = now();
    passes[i].body();
    seconds[i] = now() - start;
  };
  const auto run_waves = [&] {
    for (size_t begin = 0, end = 0; begin < passes.size(); begin = end) {
      end = wave_end(passes, begin);
      if (in_order || end - begin == 1) {
        for (size_t i = begin; i < end; ++i) run_pass(i);
      } else {
        run(end - begin, [&](size_t i) { run_pass(begin + i); });
      }
      if (after) after(names(passes, begin, end));
    }
  };
  if (arena_ == nullptr || in_order) {
    run_waves();
  } else {
    arena_->tbb.execute(run_waves);  // once, not loop by loop
  }
  for (size_t i = 0; i < passes.size(); ++i) *passes[i].seconds += seconds[i];
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace plc
