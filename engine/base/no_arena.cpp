// Where there is no oneTBB (PELLICLE_TBB=OFF): one thread, unless the host lends its own.
#include "engine/base/tbb_arena.h"

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
