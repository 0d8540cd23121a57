#include "tools/command/interrupt.h"

#include <unistd.h>
#include <atomic>
#include <csignal>

#include "tools/file/temporary.h"

namespace plc::tools {

namespace {

constexpr int kNever = 0;
constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};

// What a signal handler may touch; the process has one set of handlers.
std::atomic<int> signals = 0;
std::atomic<int> signals_that_end = 1;
std::atomic<bool> pipe_has_closed = false;
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

void tell_end() {
  if (pipe_has_closed) return;
  constexpr char kLine[] = "pellicle: interrupted\n";
  const auto written = write(STDERR_FILENO, kLine, sizeof kLine - 1);
  (void)written;
}

void on_signal(int signal) {
  if (signal == SIGPIPE) pipe_has_closed = true;
  const int count = ++signals;
  const int end = signals_that_end;
  if (end == kNever || count < end) return;
  remove_temporaries();
  tell_end();
  _exit(kExitInterrupted);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  for (const int signal : kSignals) sigaddset(&action.sa_mask, signal);
  action.sa_flags = SA_RESTART;
  for (const int signal : kSignals) {
    struct sigaction before = {};
    sigaction(signal, nullptr, &before);
    if (signal == SIGHUP && before.sa_handler == SIG_IGN) continue;
    sigaction(signal, &action, nullptr);
  }
}

void InterruptGuard::end_at_once() {
  signals_that_end = 1;
}
void InterruptGuard::note_first() {
  signals_that_end = 2;
}
void InterruptGuard::only_note() {
  signals_that_end = kNever;
}

bool InterruptGuard::interrupted() const {
  return signals > 0;
}

int InterruptGuard::tell() const {
  tell_end();
  return kExitInterrupted;
}

bool InterruptGuard::pipe_closed() const {
  return pipe_has_closed;
}

}  // namespace plc::tools
