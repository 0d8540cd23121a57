#include "tools/interrupt.h"

#include <unistd.h>
#include <csignal>

namespace plc::tools {

namespace {

// What a signal handler may touch; the process has one set of handlers.
volatile std::sig_atomic_t signals = 0;
volatile std::sig_atomic_t signals_that_end = 2;

constexpr std::sig_atomic_t kNever = 0;

void on_signal(int) {
  signals = signals + 1;
  if (signals_that_end == kNever || signals < signals_that_end) return;
  constexpr char kLine[] = "pellicle: interrupted\n";
  const auto written = write(STDERR_FILENO, kLine, sizeof kLine - 1);
  (void)written;
  _exit(kExitInterrupted);
}

void install(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

InterruptGuard::InterruptGuard() {
  signals = 0;
  signals_that_end = 2;
  install(on_signal);
}

InterruptGuard::~InterruptGuard() {
  install(SIG_DFL);
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

}  // namespace plc::tools
