// Threads of a host, as it may lend them to a context: in order, backwards, on threads of its own.
#pragma once
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

#include "engine/pellicle.h"

namespace samples {

// What a hook of plc_parallel_for_fn has seen.
struct Pool {
  std::atomic<int64_t> loops{0}, tasks{0};
};

inline void run_serially(size_t tasks, plc_task_fn task, void* data, void* user) {
  auto& pool = *static_cast<Pool*>(user);
  ++pool.loops;
  for (size_t i = 0; i < tasks; ++i) task(i, data);
  pool.tasks += static_cast<int64_t>(tasks);
}

inline void run_backwards(size_t tasks, plc_task_fn task, void* data, void* user) {
  auto& pool = *static_cast<Pool*>(user);
  ++pool.loops;
  for (size_t i = tasks; i-- > 0;) task(i, data);
  pool.tasks += static_cast<int64_t>(tasks);
}

// Each task on one of three threads that come and go with the loop.
inline void run_on_threads(size_t tasks, plc_task_fn task, void* data, void* user) {
  auto& pool = *static_cast<Pool*>(user);
  ++pool.loops;
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t i = next++; i < tasks; i = next++) {
      task(i, data);
      ++pool.tasks;
    }
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i) threads.emplace_back(work);
  for (std::thread& t : threads) t.join();
}

}  // namespace samples
