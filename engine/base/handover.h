// What passes from thread to thread by way of oneTBB, told to ThreadSanitizer: it sees only the
// synchronisation of what is instrumented, and would take what a task reads for a race. In other
// builds, nothing.
#pragma once

#if defined(__SANITIZE_THREAD__)
#define PLC_THREADS_WATCHED 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define PLC_THREADS_WATCHED 1
#endif
#endif

#ifdef PLC_THREADS_WATCHED
#include <sanitizer/tsan_interface.h>
#endif

namespace plc {

// What this thread has done happens before what any thread does after it has taken over the same
// place in memory. For each direction a place of its own: tasks that hand over and take over at one
// would seem to run one after the other.
inline void hand_over([[maybe_unused]] void* place) {
#ifdef PLC_THREADS_WATCHED
  __tsan_release(place);
#endif
}
inline void take_over([[maybe_unused]] void* place) {
#ifdef PLC_THREADS_WATCHED
  __tsan_acquire(place);
#endif
}

}  // namespace plc
