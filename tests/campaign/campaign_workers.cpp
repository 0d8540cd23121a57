#include "tests/campaign/campaign_workers.h"

#include <oneapi/tbb/global_control.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <vector>

#include "engine/base/schedule.h"

namespace campaign {

namespace {

static_assert(sizeof(Note) <= 4096, "a write to a pipe is whole up to PIPE_BUF");

template <size_t kSize>
void put(char (&to)[kSize], const std::string& text) {
  std::snprintf(to, kSize, "%s", text.c_str());
}

Note note_of(const Case& c, const Result& result) {
  Note note{};
  const RunRecord& first = result.runs[0];
  note.seed = c.seed;
  note.finding = result.finding;
  note.status = first.status;
  note.init = c.parameters.init;
  note.iterations = static_cast<int>(first.iterations.size());
  note.vertices = first.vertices;
  note.seconds = result.seconds;
  const RunRecord& second = result.runs[1];
  note.steps = c.second.steps;
  note.saved = second.saved;
  note.paused = second.paused;
  note.own_memory = c.second.own_memory;
  note.backwards = c.second.backwards;
  note.strided = c.second.strided;
  note.out_of_memory = second.status == PLC_OUT_OF_MEMORY;
  put(note.phantom, c.phantom);
  put(note.fault, c.fault);
  put(note.message, first.message);
  put(note.what, result.what);
  return note;
}

// A case that eats memory is not to take the machine with it. Sanitizers reserve more.
void limit_memory() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  constexpr rlim_t kBytes = rlim_t{8} << 30;
  const rlimit limit{kBytes, kBytes};
  setrlimit(RLIMIT_AS, &limit);
#endif
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
}

// Seeds come in, notes go out, until there are no more.
[[noreturn]] void work(int in, int out, const std::function<Note(uint64_t)>& run) {
  limit_memory();
  uint64_t seed = 0;
  while (read(in, &seed, sizeof seed) == sizeof seed) {
    const Note note = run(seed);
    if (write(out, &note, sizeof note) != sizeof note) break;
  }
  _exit(0);
}

struct Worker {
  pid_t pid = -1;
  int in = -1, out = -1;  // seeds to it, notes from it
  bool busy = false;
  uint64_t seed = 0;
  double since = 0;  // of the clock
  double processor_then = 0;
};

// That the process has used so far.
double processor_seconds(pid_t pid) {
  clockid_t clock{};
  timespec used{};
  if (clock_getcpuclockid(pid, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

class Pool {
 public:
  Pool(const Workers& options, const std::function<Note(uint64_t)>& run,
       const std::function<void(const Note&)>& tell)
      : options_(options), run_(run), tell_(tell) {}

  bool run(uint64_t from, uint64_t count);

 private:
  bool start(Worker& worker);
  void give(Worker& worker, uint64_t seed);
  void lost(Worker& worker, bool hangs);
  void listen(Worker& worker);
  bool hangs(const Worker& worker) const;
  static void stop(Worker& worker);

  const Workers& options_;
  const std::function<Note(uint64_t)>& run_;
  const std::function<void(const Note&)>& tell_;
  std::vector<Worker> workers_;
};

bool Pool::start(Worker& worker) {
  int seeds[2], notes[2];
  if (pipe(seeds) != 0) return false;
  if (pipe(notes) != 0) {
    close(seeds[0]);
    close(seeds[1]);
    return false;
  }
  const pid_t pid = fork();
  if (pid == 0) {
    // The ends that belong to the parent, of all workers: an end kept open hides that it is gone.
    close(seeds[1]);
    close(notes[0]);
    for (const Worker& other : workers_) {
      if (other.in >= 0) close(other.in);
      if (other.out >= 0) close(other.out);
    }
    work(seeds[0], notes[1], run_);
  }
  close(seeds[0]);
  close(notes[1]);
  worker = {pid, seeds[1], notes[0], false, 0, 0, 0};
  if (pid > 0) return true;
  close(worker.in);
  close(worker.out);
  worker.in = worker.out = -1;
  return false;
}

void Pool::give(Worker& worker, uint64_t seed) {
  worker.busy = true;
  worker.seed = seed;
  worker.since = plc::now();
  worker.processor_then = processor_seconds(worker.pid);
  // Should it be gone already, reading from it tells.
  if (write(worker.in, &seed, sizeof seed) != sizeof seed) return;
}

bool Pool::hangs(const Worker& worker) const {
  return processor_seconds(worker.pid) - worker.processor_then > options_.timeout ||
         plc::now() - worker.since > 10 * options_.timeout;
}

void Pool::stop(Worker& worker) {
  close(worker.in);
  close(worker.out);
  worker.in = worker.out = -1;
}

void Pool::lost(Worker& worker, bool hangs) {
  if (hangs) kill(worker.pid, SIGKILL);
  int status = 0;
  waitpid(worker.pid, &status, 0);
  stop(worker);
  worker.busy = false;
  Note note{};
  note.seed = worker.seed;
  note.init = -1;
  note.seconds = plc::now() - worker.since;
  note.finding = hangs ? Finding::kHang : Finding::kCrash;
  put(note.phantom, "?");
  if (hangs) {
    put(note.what, "not through after " + std::to_string(note.seconds) + " s");
  } else if (WIFSIGNALED(status)) {
    put(note.what, std::string("signal ") + strsignal(WTERMSIG(status)));
  } else {
    put(note.what, "the process has ended with code " + std::to_string(WEXITSTATUS(status)));
  }
  tell_(note);
}

void Pool::listen(Worker& worker) {
  Note note{};
  if (read(worker.out, &note, sizeof note) != sizeof note) return lost(worker, false);
  worker.busy = false;
  tell_(note);
}

bool Pool::run(uint64_t from, uint64_t count) {
  std::signal(SIGPIPE, SIG_IGN);
  workers_.resize(static_cast<size_t>(options_.jobs));
  uint64_t next = from;
  for (;;) {
    std::vector<pollfd> open;
    std::vector<size_t> whose;
    for (size_t i = 0; i < workers_.size(); ++i) {
      Worker& worker = workers_[i];
      if (!worker.busy && next < from + count) {
        if (worker.in < 0 && !start(worker)) return false;
        give(worker, next++);
      }
      if (!worker.busy) continue;
      open.push_back({worker.out, POLLIN, 0});
      whose.push_back(i);
    }
    if (open.empty()) break;
    if (poll(open.data(), open.size(), 1000) < 0 && errno != EINTR) return false;
    for (size_t k = 0; k < open.size(); ++k) {
      Worker& worker = workers_[whose[k]];
      if (open[k].revents != 0) {
        listen(worker);
      } else if (hangs(worker)) {
        lost(worker, true);
      }
    }
  }
  for (Worker& worker : workers_) {
    if (worker.in < 0) continue;
    stop(worker);
    waitpid(worker.pid, nullptr, 0);
  }
  return true;
}

}  // namespace

Note run_seed(uint64_t seed) {
  // oneTBB gives a process as many threads as there are cores, unless it is told.
  using Control = oneapi::tbb::global_control;
  static const Control threads(Control::max_allowed_parallelism, 8);
  const Case c = make_case(seed);
  return note_of(c, run_case(c));
}

bool run_seeds(const Workers& workers, uint64_t from, uint64_t count,
               const std::function<Note(uint64_t)>& run,
               const std::function<void(const Note&)>& tell) {
  return Pool(workers, run, tell).run(from, count);
}

}  // namespace campaign
