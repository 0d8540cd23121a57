#include "engine/base/schedule.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>

#include "engine/base/float_environment.h"
#include "engine/base/handover.h"
#include "engine/base/tbb_arena.h"
#include "engine/base/team.h"
#include "pyramid/memory.h"

namespace plc {

namespace {

// What the tasks of a loop throw: not through the host's threads.
class FirstException {
 public:
  void take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!first_) first_ = std::current_exception();
  }
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::mutex mutex_;
  std::exception_ptr first_;
};

// Daemon threads of a host may still compute when the process ends, and oneTBB is gone before they
// are: it is not asked for threads any more. What this library registers is destroyed before what
// the libraries that it needs have registered.
std::mutex end_mutex;
bool process_ends = false;
const struct EndOfProcess {
  ~EndOfProcess() {
    const std::lock_guard<std::mutex> lock(end_mutex);
    process_ends = true;
  }
} end_of_process;

// What a helper is called with.
struct Summons {
  std::shared_ptr<Team> team;
  uint32_t slot;
};

void serve(size_t, void* data) {
  take_over(data);
  const std::unique_ptr<Summons> summons(static_cast<Summons*>(data));
  summons->team->serve(summons->slot);
}

// A loop that oneTBB runs. Its task has two places to hand over at: where the loop begins, and
// where the task ends.
struct Loop {
  const std::function<void(size_t)>& body;
  char begin = 0, end = 0;

  static void run_task(size_t i, void* data) {
    auto& loop = *static_cast<Loop*>(data);
    take_over(&loop.begin);
    loop.body(i);
    hand_over(&loop.end);
  }
};

}  // namespace

// Where threads come from: an arena of oneTBB, this schedule's own or that of whoever calls.
class Schedule::Arena {
 public:
  // threads: as a TbbArena has them.
  explicit Arena(int threads) : tbb_(threads) {}
  ~Arena() { leave_team(); }
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  void run(int threads, size_t tasks, const std::function<void(size_t)>& body);
  // Several loops at a time, which may run others.
  void run_wave(size_t tasks, const std::function<void(size_t)>& body);

 private:
  void leave_team();
  void summon(uint32_t slot);
  void run_tbb(size_t tasks, const std::function<void(size_t)>& body);

  TbbArena tbb_;
  std::shared_ptr<Team> team_;  // with every helper that has been summoned, and may come late
  bool in_wave_ = false;
};

void Schedule::Arena::run(int threads, size_t tasks, const std::function<void(size_t)>& body) {
  if (in_wave_) return run_tbb(tasks, body);
  const auto members = static_cast<uint32_t>(threads);
  if (team_ == nullptr || team_->members() < members) {
    leave_team();
    team_ = std::make_shared<Team>(members);
  }
  const auto summon_helper = [this](uint32_t slot) { summon(slot); };
  if (team_->run(tasks, members, body, summon_helper)) return;
  for (size_t i = 0; i < tasks; ++i) body(i);  // a loop within a loop
}

// Loops within loops are what oneTBB is good at.
void Schedule::Arena::run_wave(size_t tasks, const std::function<void(size_t)>& body) {
  if (team_ != nullptr) team_->dismiss();
  in_wave_ = true;
  const struct End {
    bool& in_wave;
    ~End() { in_wave = false; }
  } end{in_wave_};
  run_tbb(tasks, body);
}

void Schedule::Arena::run_tbb(size_t tasks, const std::function<void(size_t)>& body) {
  Loop loop{body};
  hand_over(&loop.begin);
  tbb_.run(tasks, Loop::run_task, &loop);
  take_over(&loop.end);
}

// One that cannot be had is done without.
void Schedule::Arena::summon(uint32_t slot) {
  const std::lock_guard<std::mutex> lock(end_mutex);
  if (process_ends || static_cast<int>(slot) >= TbbArena::threads_of_process()) return;
  try {
    auto summons = std::make_unique<Summons>(Summons{team_, slot});
    hand_over(summons.get());
    tbb_.enqueue(serve, summons.get());
    (void)summons.release();  // serve has it
  } catch (const std::exception&) {
  }
}

void Schedule::Arena::leave_team() {
  if (team_ == nullptr) return;
  team_->dismiss();
  team_->wait_for_helpers();
}

Schedule::Schedule(const Threads& threads, SimdTarget simd) : Executor(simd), threads_(threads) {
  if (threads.parallel_for != nullptr) return;
  // More than oneTBB has it does not give, and would say so on stderr.
  threads_.count = std::min(threads.count, TbbArena::threads_of_process());
  if (threads_.count != 1) arena_ = std::make_unique<Arena>(threads_.count);
}
Schedule::~Schedule() = default;

int Schedule::threads() const {
  if (threads_.parallel_for != nullptr) return 0;
  return threads_.count != 0 ? threads_.count : TbbArena::threads_of_caller();
}

void Schedule::run(size_t tasks, const std::function<void(size_t)>& body) const {
  run(tasks, body, false);
}

// wave: the tasks are passes, with loops of their own.
void Schedule::run(size_t tasks, const std::function<void(size_t)>& body, bool wave) const {
  const int most = threads();
  if (tasks <= 1 || most == 1) {
    for (size_t i = 0; i < tasks; ++i) body(i);
    return;
  }
  Memory& memory = Memory::current();
  FirstException exception;
  const auto guarded = [&](size_t i) {
    const MemoryScope scope(memory);
    try {
      body(i);
    } catch (...) {
      exception.take();
    }
  };
  if (arena_ == nullptr) {
    run_on_host(tasks, guarded);
  } else if (wave) {
    arena_->run_wave(tasks, guarded);
  } else {
    arena_->run(most, tasks, guarded);
  }
  exception.rethrow();
}

void Schedule::run_on_host(size_t tasks, const std::function<void(size_t)>& body) const {
  const auto task = [](size_t i, void* data) {
    const FloatEnvironment environment;
    (*static_cast<const std::function<void(size_t)>*>(data))(i);
  };
  threads_.parallel_for(tasks, task, const_cast<std::function<void(size_t)>*>(&body),
                        threads_.user);
}

namespace {

bool conflict(const Pass& a, const Pass& b) {
  return (a.writes & (b.reads | b.writes)) != 0 || (a.reads & b.writes) != 0;
}

// The passes from `begin` on, in the order of the table, that may run at the same time.
size_t wave_end(const std::vector<Pass>& passes, size_t begin) {
  size_t end = begin + 1;
  for (; end < passes.size(); ++end) {
    for (size_t i = begin; i < end; ++i) {
      if (conflict(passes[i], passes[end])) return end;
    }
  }
  return end;
}

void tell(const PassEnd& after, const std::vector<Pass>& passes, size_t begin, size_t end) {
  std::string names = passes[begin].name;
  uint32_t writes = passes[begin].writes;
  for (size_t i = begin + 1; i < end; ++i) {
    names.append(", ").append(passes[i].name);
    writes |= passes[i].writes;
  }
  after(names, writes);
}

}  // namespace

// The graph of the table by its levels. Its passes are loops over all vertices and nearly a chain:
// nodes and edges built anew for every step would buy nothing over this. A host's threads are not
// asked for loops within loops: passes then run in order.
Status Schedule::run_passes(const std::vector<Pass>& passes, bool small,
                            const PassEnd& after) const {
  const bool in_order = small || threads() == 1 || threads_.parallel_for != nullptr;
  std::vector<double> seconds(passes.size(), 0);
  std::vector<Status> status(passes.size());
  const auto run_pass = [&](size_t i) {
    const double start = now();
    status[i] = passes[i].body();
    seconds[i] = now() - start;
  };
  const auto failed = [](const Status& s) { return !s.ok(); };
  auto first_failed = status.end();
  for (size_t begin = 0, end = 0; begin < passes.size(); begin = end) {
    end = wave_end(passes, begin);
    if (in_order || end - begin == 1) {
      for (size_t i = begin; i < end; ++i) run_pass(i);
    } else {
      run(
          end - begin, [&](size_t i) { run_pass(begin + i); }, true);
    }
    first_failed = std::find_if(status.begin(), status.end(), failed);
    if (first_failed != status.end()) break;
    if (after) tell(after, passes, begin, end);
  }
  for (size_t i = 0; i < passes.size(); ++i) *passes[i].seconds += seconds[i];
  return first_failed == status.end() ? Status() : *first_failed;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace plc
