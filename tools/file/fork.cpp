#include "tools/file/fork.h"

#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

namespace plc::tools {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};

void replace_handlers(Caught caught) {
  for (const int signal : kSignals) {
    struct sigaction action = {};
    sigaction(signal, nullptr, &action);
    if (action.sa_handler == SIG_DFL || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = caught == Caught::kEnd ? SIG_DFL : SIG_IGN;
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace

pid_t fork_unhandled(Caught caught) {
  sigset_t these;
  sigset_t before;
  sigemptyset(&these);
  for (const int signal : kSignals) sigaddset(&these, signal);
  pthread_sigmask(SIG_BLOCK, &these, &before);
  const pid_t child = fork();
  const int error = errno;
  if (child == 0) replace_handlers(caught);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  return child;
}

}  // namespace plc::tools
