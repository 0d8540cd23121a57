#include "engine/task_threads.h"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace plc {

void run_on_task_threads(int threads, size_t tasks, const std::function<void(size_t)>& body) {
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t i = next++; i < tasks; i = next++) body(i);
  };
  const size_t helpers = std::min(static_cast<size_t>(threads), tasks) - 1;
  std::vector<std::thread> others;
  others.reserve(helpers);
  for (size_t i = 0; i < helpers; ++i) others.emplace_back(work);
  work();
  for (std::thread& t : others) t.join();
}

}  // namespace plc
