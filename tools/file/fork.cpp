#include "tools/file/fork.h"

#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace plc::tools {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};

void replace_handlers(Interrupts interrupts) {
  for (const int signal : kSignals) {
    // In this order: to ignore one takes it away that is waiting.
    const auto before = std::signal(signal, SIG_DFL);
    if (interrupts == Interrupts::kIgnored || before == SIG_IGN) std::signal(signal, SIG_IGN);
  }
}

}  // namespace

pid_t fork_unhandled(Interrupts interrupts) {
  sigset_t these;
  sigset_t before;
  sigemptyset(&these);
  for (const int signal : kSignals) sigaddset(&these, signal);
  pthread_sigmask(SIG_BLOCK, &these, &before);
  const pid_t child = fork();
  const int error = errno;
  if (child == 0) replace_handlers(interrupts);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  return child;
}

}  // namespace plc::tools
