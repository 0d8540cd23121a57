// Threads that run one parallel loop after the other, awake in between.
//
// A step is some twenty loops with serial code between them, in which oneTBB's workers go to sleep.
// A team has these workers, each as one task that serves loop after loop. perf/bench_loops
// compares.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace plc {

class Team {
 public:
  // Asks for a thread that calls serve(slot), now or later or never. Does not throw.
  using Summon = std::function<void(uint32_t slot)>;
  // The calling thread, and up to members - 1 helpers.
  explicit Team(uint32_t members) : places_(members) {}
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  uint32_t members() const { return static_cast<uint32_t>(places_.size()); }
  // Calls body(0) .. body(tasks - 1), each once, on the calling thread and such helpers as have
  // come, members - 1 at most; summons those that are not there. 1 <= members <= members(). A
  // member begins with its own share of the tasks, which is the same in every loop of so many: what
  // they touch is in its caches. body does not throw. False, and nothing is called: a loop of this
  // team is being run, by another thread or by a task of which this call is a part.
  bool run(size_t tasks, uint32_t members, const std::function<void(size_t)>& body,
           const Summon& summon);
  // Helps with loops until none has come for kAwake, for kTenure at most, or until dismiss().
  void serve(uint32_t slot);
  // Helpers leave as soon as they have no task. They may be summoned again.
  void dismiss() { ++dismissals_; }
  // Until all that were summoned have left, for kPatience at most.
  void wait_for_helpers() const;

 private:
  struct alignas(64) Place {
    std::atomic<size_t> next{0};        // task of this member's share
    std::atomic<bool> summoned{false};  // ... and has not left since
  };
  // The loop at hand, as it is told to helpers: its number and how many may take part; 0: none.
  static uint64_t ticket(uint64_t loop, uint32_t members) { return loop << 16U | members; }
  static uint32_t wanted(uint64_t ticket) { return static_cast<uint32_t>(ticket & 0xffffU); }
  size_t share_end(uint32_t share) const { return tasks_ * (share + 1) / joined_; }
  void work(uint32_t slot);

  // In one line of the cache but for `open_`, which those who wait look at.
  alignas(64) std::atomic<uint32_t> working_{0};  // helpers
  uint32_t joined_ = 1;                           // joined_, body_, tasks_: of the loop at hand,
  uint64_t loops_ = 0;                            // written while no helper works
  const std::function<void(size_t)>* body_ = nullptr;
  size_t tasks_ = 0;
  std::vector<Place> places_;  // by slot; the caller's is 0
  std::atomic<uint32_t> dismissals_{0};
  std::atomic<bool> busy_{false};
  alignas(64) std::atomic<uint64_t> open_{0};
};

}  // namespace plc
