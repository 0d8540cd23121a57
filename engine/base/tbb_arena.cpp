#include "engine/base/tbb_arena.h"

#if !PELLICLE_TBB  // an option of CMake

// One thread, unless the host lends its own.
namespace plc {

struct TbbArena::Own {};

TbbArena::TbbArena(int) {}
TbbArena::~TbbArena() = default;

void TbbArena::run(size_t tasks, Task task, void* data) {
  for (size_t i = 0; i < tasks; ++i) task(i, data);
}
void TbbArena::enqueue(Task, void*) {}

int TbbArena::threads_of_process() {
  return 1;
}
int TbbArena::threads_of_caller() {
  return 1;
}

}  // namespace plc

#else

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

namespace plc {

struct TbbArena::Own {
  oneapi::tbb::task_arena arena;
};

TbbArena::TbbArena(int threads) {
  if (threads > 0) own_.reset(new Own{oneapi::tbb::task_arena(threads)});
}
TbbArena::~TbbArena() = default;

void TbbArena::run(size_t tasks, Task task, void* data) {
  // Of no group of the caller's: that one may be cancelled, and its loops then do nothing.
  using Group = oneapi::tbb::task_group_context;
  Group group(Group::isolated, Group::default_traits | Group::fp_settings);
  const auto loop = [&] {
    oneapi::tbb::parallel_for(
        size_t{0}, tasks, [&](size_t i) { task(i, data); }, group);
  };
  if (own_ != nullptr) {
    own_->arena.execute(loop);
  } else {
    // A thread that waits for the loop takes no other work of the host's meanwhile, which might
    // come back to this context.
    oneapi::tbb::this_task_arena::isolate(loop);
  }
}

void TbbArena::enqueue(Task task, void* data) {
  const auto one = [task, data] { task(0, data); };
  if (own_ != nullptr) {
    own_->arena.enqueue(one);
  } else {
    oneapi::tbb::this_task_arena::enqueue(one);
  }
}

int TbbArena::threads_of_process() {
  using Control = oneapi::tbb::global_control;
  const size_t most = Control::active_value(Control::max_allowed_parallelism);
  return static_cast<int>(std::min<size_t>(most, 1024));
}

int TbbArena::threads_of_caller() {
  return oneapi::tbb::this_task_arena::max_concurrency();
}

}  // namespace plc

#endif
