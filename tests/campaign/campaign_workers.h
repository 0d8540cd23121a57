// Runs cases in processes of their own: one that crashes or hangs is told by its seed, and the
// others go on.
#pragma once
#include <cstdint>
#include <functional>

#include "tests/campaign/campaign_run.h"

namespace campaign {

// What a worker tells of a case, small enough for one write to a pipe.
struct Note {
  uint64_t seed;
  Finding finding;
  plc_status status;
  int init;
  int iterations;
  bool steps, saved, paused, own_memory, backwards, strided;  // of the second run, as they came
  bool out_of_memory;                                         // ... which it ended for
  int64_t vertices;
  double seconds;  // of the processor; of the clock where it did not come to its end
  char phantom[16];
  char fault[48];     // empty: none
  char message[320];  // of the first run
  char what[480];     // of the finding
};

struct Workers {
  int jobs = 1;
  // Seconds of the processor for a case, in which a busy machine may be slow; ten times as many of
  // the clock, for one that waits for ever.
  double timeout = 60;
};

// Makes the case of a seed and runs it.
Note run_seed(uint64_t seed);

// The seeds from .. from + count - 1, about in this order: `run` in a worker, `tell` on the calling
// thread. The calling process must have one thread only. False where no process can be started.
bool run_seeds(const Workers& workers, uint64_t from, uint64_t count,
               const std::function<Note(uint64_t)>& run,
               const std::function<void(const Note&)>& tell);

}  // namespace campaign
