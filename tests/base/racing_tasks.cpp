// Tasks that race on purpose, as the engine runs its own: ThreadSanitizer must tell, else it is
// blind to what runs on oneTBB's threads.
//   racing_tasks loop|wave   a loop of the team; passes that run at the same time
#include <oneapi/tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <string>
#include <thread>

#include "engine/base/schedule.h"

namespace {

std::atomic<int> begun{0};
int written = 0;

// Both have begun before one ends: on two threads. What they wait with orders nothing.
void race() {
  ++written;
  begun.fetch_add(1, std::memory_order_relaxed);
  for (int i = 0; i < 30000 && begun.load(std::memory_order_relaxed) < 2; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string kind = argc == 2 ? argv[1] : "";
  // As many as are asked for, even on one core.
  using Control = oneapi::tbb::global_control;
  const Control threads(Control::max_allowed_parallelism, 4);
  const plc::Schedule schedule(4);
  double seconds = 0;
  if (kind == "loop") {
    schedule.run(2, [](size_t) { race(); });
  } else if (kind == "wave") {
    const std::vector<plc::Pass> table{{"one", 0, plc::kNormals, &seconds, race},
                                       {"two", 0, plc::kRestLength, &seconds, race}};
    if (!schedule.run_passes(table, false).ok()) return 1;
  } else {
    std::fputs("usage: racing_tasks loop|wave\n", stderr);
    return 2;
  }
  std::printf("%d tasks have met\n", begun.load());
}
