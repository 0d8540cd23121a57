// Parallel loops without oneTBB, for builds under ThreadSanitizer: it follows the synchronisation
// of what is instrumented, and oneTBB as the system has it is not.
#pragma once
#include <cstddef>
#include <functional>

namespace plc {

// body(0) .. body(tasks - 1) on `threads` threads, the calling one included; they start and end
// with the loop. Bodies do not throw.
void run_on_task_threads(int threads, size_t tasks, const std::function<void(size_t)>& body);

}  // namespace plc
