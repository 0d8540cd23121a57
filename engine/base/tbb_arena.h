// Threads of oneTBB: the only file pair that calls it, and does without it where there is none.
//
// For ThreadSanitizer it belongs to oneTBB, whose templates it holds: neither is instrumented, as
// the library that the system has is not. Whoever hands tasks over tells what happens before what
// (handover.h).
#pragma once
#include <cstddef>
#include <memory>

namespace plc {

class TbbArena {
 public:
  using Task = void (*)(size_t task, void* data);

  // threads: of an arena of its own; 0: the arena that the caller is in when it asks for something.
  explicit TbbArena(int threads);
  ~TbbArena();
  TbbArena(const TbbArena&) = delete;
  TbbArena& operator=(const TbbArena&) = delete;

  // task(0, data) .. task(tasks - 1, data), each once; returns when all have ended. They compute as
  // this thread does, may run loops of their own, and do not throw.
  void run(size_t tasks, Task task, void* data);
  // Asks for task(0, data) on another thread: it runs now, later or never. Throws where no task can
  // be made.
  void enqueue(Task task, void* data);

  // How many threads oneTBB uses in this process at most: the host decides.
  static int threads_of_process();
  static int threads_of_caller();

 private:
  struct Own;
  std::unique_ptr<Own> own_;  // null: the caller's
};

}  // namespace plc
