// Parallel loops whose bodies need scratch memory of their own.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <new>

#include "pyramid/executor.h"

namespace plc {

// executor.run(tasks, body); false when a body threw std::bad_alloc, which must not leave a thread.
inline bool run_guarded(const Executor& executor, size_t tasks,
                        const std::function<void(size_t)>& body) {
  std::atomic<bool> out_of_memory{false};
  executor.run(tasks, [&](size_t task) {
    try {
      body(task);
    } catch (const std::bad_alloc&) {
      out_of_memory = true;
    }
  });
  return !out_of_memory;
}

}  // namespace plc
