// Threads: parallel loops and the task graph of a step, on those of oneTBB (tbb_arena.h) or a host.
//
// The determinism contract: the same input and parameters give the same bits for any number of
// threads, on any SIMD target and processor, by GCC and Clang, run after run. It holds by
// construction, as long as everything that changes the surface keeps to this:
//
//   Loops      Gather, never scatter: a task writes what belongs to its own vertices and reads what
//              no task of the pass writes; marks that several tasks set to the same value are
//              atomic (marks.h). Tasks are fixed blocks (blocks.h, kGrain), whatever the
//              number of threads. No task asks which thread it is on, how many there are, what time
//              it is, or in which order tasks ended.
//   Sums       Over a block in the order of lane_sum.h, over blocks from the first to the last.
//              No atomics on floats, no reduction by the thread library.
//   Order      What tasks have found is joined in the order of tasks. Sorts have total keys: two
//              that compare equal mean the same. Nothing is ordered by addresses or by the places
//              of a hash table. Operations are tried in parallel, and applied in that order on one
//              thread, whatever was tried (trials.h); ids are taken from the free list, and
//              given out anew along the Morton curve, ties by old id.
//   Rounding   Every operation rounds once, in the order written: -ffp-contract=off, no MulAdd, no
//              approximate reciprocal or root, no -ffast-math, no -march. A kernel has the bits of
//              its scalar twin on every target (kernels/scalar.h), tails, padding and deleted
//              vertices included. Of the mathematics library only what is exact or rounded
//              correctly (sqrt, floor): the rest differs between C libraries, and processors. The
//              exponential function is our own (exponential.h). Measures of a finished surface
//              (angles, curvatures, geodesic distances) and the progress told may use the rest.
//   State      Sleep, wake, due and risk depend on the bits of the mesh's streams, and on what the
//              passes before have done with them, alone. Buffers that are not written whole start
//              as zeros (Buffer::resize).
//
// Who holds it to that: tests/kernels/test_golden_kernels.cpp has a recorded hash for every kernel
// and names the one that rounds differently; tests/recover/test_determinism.cpp has recorded hashes
// of runs that take the parallel path, over threads and targets, and compares two runs pass by
// pass: the first that differs is named, "iteration 17, pass stage 2: velocity" (pass_observer.h,
// tests/samples/sample_traces.h); tests/tools/test_ct_determinism.sh extracts a head CT;
// tests/tools/test_c_library.sh names the file that calls what is not exact; tools/compilers runs
// the recorded hashes with other compilers and on other processors. A change that changes results
// on purpose records them anew, and says so.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "pyramid/executor.h"
#include "pyramid/status.h"

namespace plc {

// What passes read and write, one bit each.
enum Resource : uint32_t {
  kRings = 1U << 0,
  kPositions = 1U << 1,
  kVelocities = 1U << 2,
  kNormals = 1U << 3,
  kRestLength = 1U << 4,
  kLaplacians = 1U << 5,
  kStages = 1U << 6,  // force, stage position and velocity, sums of Runge-Kutta
  kDisplacements = 1U << 7,
  kStep = 1U << 8,  // its time; the energy and speed of what has moved
  kUserForce = 1U << 9,
  kAwake = 1U << 10,  // who takes part in the step
  kCalm = 1U << 11,   // for how long vertices have been calm, and their turns
  kDue = 1U << 12,    // who is due for a check, and the paths and periods that say so
  kHash = 1U << 13,
  kSurroundings = 1U << 14,
  kFolds = 1U << 15,
  kRisk = 1U << 16,
  kTakenBack = 1U << 17,
};
inline constexpr uint32_t kEverything = ~0U;

// One row of the table of passes. Passes keep their order where one writes what the other reads or
// writes; where not, they may run at the same time.
struct Pass {
  // seconds: where the time of the pass is added; not null, may be shared. body: returns a Status,
  // or nothing where it cannot fail.
  template <typename Body>
  Pass(std::string called, uint32_t read, uint32_t written, double* time, Body run)
      : name(std::move(called)), reads(read), writes(written), seconds(time) {
    if constexpr (std::is_void_v<std::invoke_result_t<Body&>>) {
      body = [run = std::move(run)]() mutable {
        run();
        return Status();
      };
    } else {
      body = std::move(run);
    }
  }

  std::string name;
  uint32_t reads;
  uint32_t writes;
  double* seconds;
  std::function<Status()> body;
};

// Of the passes that have just ended: their names, with ", " between those that may run at the same
// time, and what the table says that they write.
using PassEnd = std::function<void(const std::string& names, uint32_t writes)>;

// Whose threads run the tasks of loops.
struct Threads {
  // One thread, or the threads of the host, where it has lent them: plc_parallel_for_fn.
  using Task = void (*)(size_t task, void* data);
  using ParallelFor = void (*)(size_t tasks, Task task, void* data, void* user);

  int count = 1;  // 0: as many as the arena of oneTBB that the caller is in, which then runs them
  ParallelFor parallel_for = nullptr;  // null: oneTBB's, as a team (team.h)
  void* user = nullptr;
};

// The threads of one context. A task runs in the memory of the thread that started the loop.
class Schedule final : public Executor {
 public:
  // threads.count >= 0.
  explicit Schedule(const Threads& threads, SimdTarget simd = best_simd_target());
  explicit Schedule(int threads, SimdTarget simd = best_simd_target())
      : Schedule(Threads{threads}, simd) {}
  ~Schedule() override;
  // How many threads loops may run on; 0: only the host knows.
  int threads() const;

  // On the calling thread where there is one thread, or one task. When tasks throw, one of their
  // exceptions is thrown on after all have ended.
  void run(size_t tasks, const std::function<void(size_t)>& body) const override;
  // Runs the table. `small`: in order, on the calling thread. `after`, which may be empty, is
  // called at the same places of the table for any number of threads, while no pass runs. Where a
  // pass fails those that come after it are left out, and its Status is returned; of several the
  // first in the table.
  Status run_passes(const std::vector<Pass>& passes, bool small, const PassEnd& after = {}) const;

 private:
  class Arena;
  void run(size_t tasks, const std::function<void(size_t)>& body, bool wave) const;
  void run_on_host(size_t tasks, const std::function<void(size_t)>& body) const;

  Threads threads_;
  std::unique_ptr<Arena> arena_;  // null where there is one thread, or the host has lent its own
};

// Seconds of a monotonic clock.
double now();

}  // namespace plc
