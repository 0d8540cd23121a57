#include "tools/file/fork.h"

#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/tools/tool_fixtures.h"
#include "tools/cohort/child.h"
#include "tools/file/apart.h"

namespace {

constexpr int kHandled = 99;  // the exit code of a child that runs this process's handler

bool raises = false;

// In a child, before fork() returns: the earliest that a signal can come.
void raise_in_child() {
  if (raises) raise(SIGTERM);
}

void handle(int) {
  _exit(kHandled);
}

// A process each of whose children gets SIGTERM at once.
class EarlySignals {
 public:
  explicit EarlySignals(void (*handler)(int)) : before_(std::signal(SIGTERM, handler)) {
    static const int added = pthread_atfork(nullptr, nullptr, raise_in_child);
    REQUIRE(added == 0);
    raises = true;
  }
  ~EarlySignals() {
    raises = false;
    std::signal(SIGTERM, before_);
  }
  EarlySignals(const EarlySignals&) = delete;
  EarlySignals& operator=(const EarlySignals&) = delete;

 private:
  void (*before_)(int);
};

}  // namespace

TEST_CASE("A signal ends a program that has not begun", "[fork]") {
  const fixtures::Folder folder;
  const EarlySignals early(handle);
  const int child = plc::tools::start_child({"/bin/sleep", "60"}, folder / "log", -1);
  plc::tools::ChildEnd end;
  while (!plc::tools::has_ended(child, end)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  CHECK(end.signal == SIGTERM);
  CHECK(end.code == 0);
}

TEST_CASE("A signal does not end what is done apart", "[fork]") {
  const plc::tools::ApartLimits limits = {20, uint64_t{1} << 30};
  const auto work = [] { return plc::tools::Parcel{"done", {}}; };
  for (const auto handler : {handle, SIG_DFL}) {
    const EarlySignals early(handler);
    CHECK(plc::tools::apart("a", "fails", limits, work).text == "done");
  }
}

TEST_CASE("The parent handles signals as before", "[fork]") {
  const EarlySignals early(handle);
  const int child = plc::tools::fork_unhandled(plc::tools::Interrupts::kIgnored);
  if (child == 0) _exit(0);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  CHECK(status == 0);
  sigset_t blocked;
  pthread_sigmask(SIG_SETMASK, nullptr, &blocked);
  CHECK(sigismember(&blocked, SIGTERM) == 0);
  struct sigaction action = {};
  sigaction(SIGTERM, nullptr, &action);
  CHECK(action.sa_handler == handle);
}
