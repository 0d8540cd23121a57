#include "tools/file/apart.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <optional>
#include <system_error>
#include <utility>

#include "tools/file/checked_sizes.h"
#include "tools/file/failure.h"
#include "tools/file/fork.h"

// Sanitizers reserve address space of their own and do not survive a limit.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PELLICLE_LIMITS_MEMORY 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PELLICLE_LIMITS_MEMORY 0
#endif
#endif
#ifndef PELLICLE_LIMITS_MEMORY
#define PELLICLE_LIMITS_MEMORY 1
#endif

// Of builds that count which lines are run: what a process that ends with _exit() has counted.
// NOLINTNEXTLINE(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" void __gcov_dump() __attribute__((weak));

namespace plc::tools {
namespace {

// Limits are the process's own, and so is whether it has been given them.
bool has_limits = false;

constexpr int kResult = 1;
constexpr int kFailure = 2;
constexpr size_t kLongestText = size_t{1} << 20;

// What is sent before the text.
struct Head {
  int kind;
  int bytes;  // as SharedBytes::received() takes them; -1: none
};

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() { reset(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  void reset() {
    if (number_ >= 0) close(std::exchange(number_, -1));
  }

 private:
  int number_;
};

// Ended and waited for, whatever happens.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    if (id_ <= 0) return;
    kill(id_, SIGKILL);
    wait();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  // As waitpid() tells it.
  int wait() {
    int status = 0;
    while (waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = 0;
    return status;
  }

 private:
  pid_t id_;
};

void set_soft_limit(decltype(RLIMIT_CPU) kind, uint64_t value) {
  rlimit limit{};
  if (getrlimit(kind, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(value, limit.rlim_max);
  setrlimit(kind, &limit);
}

void add_to_soft_limit(decltype(RLIMIT_CPU) kind, uint64_t more) {
  rlimit limit{};
  if (getrlimit(kind, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  set_soft_limit(kind, plus(limit.rlim_cur, more));
}

[[maybe_unused]] uint64_t mapped_bytes() {
  uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return times(pages, static_cast<uint64_t>(sysconf(_SC_PAGESIZE)));
}

uint64_t whole_seconds(double seconds) {
  return static_cast<uint64_t>(std::ceil(std::min(seconds, 1e9)));
}

void set_limits(const ApartLimits& limits) {
  set_soft_limit(RLIMIT_CORE, 0);
  prctl(PR_SET_DUMPABLE, 0);  // where cores go to a program, the limit above does not count
  set_soft_limit(RLIMIT_CPU, whole_seconds(limits.seconds));
#if PELLICLE_LIMITS_MEMORY
  set_soft_limit(RLIMIT_AS, plus(mapped_bytes(), limits.bytes));
#endif
  has_limits = true;
}

void be_silent() {
  const int null = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (int i = 0; i < 3 && null >= 0; ++i) dup2(null, i);
}

bool send_all(int socket, const char* data, size_t size) {
  while (size > 0) {
    const ssize_t sent = send(socket, data, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) return false;
    data += sent;
    size -= static_cast<size_t>(sent);
  }
  return true;
}

// The parent closes its end when it has all: until then the bytes must not go.
bool send_parcel(int socket, const Head& head, const std::string& text) {
  if (!send_all(socket, reinterpret_cast<const char*>(&head), sizeof head) ||
      !send_all(socket, text.data(), text.size()) || shutdown(socket, SHUT_WR) != 0) {
    return false;
  }
  char none = 0;
  while (recv(socket, &none, 1, 0) < 0 && errno == EINTR) {
  }
  return true;
}

[[noreturn]] void run_child(pid_t parent, int socket, const std::string& failed,
                            const ApartLimits& limits, const std::function<Parcel()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);  // it has died before that
  be_silent();
  set_limits(limits);
  std::string message;
  bool sent = false;
  try {
    const Parcel parcel = work();
    sent = send_parcel(socket, {kResult, parcel.bytes.id()}, parcel.text);
  } catch (const Failure& failure) {
    message = failure.message;
  } catch (const std::bad_alloc&) {
    message = failed + " (not enough memory)";
  } catch (const std::exception& e) {
    message = failed + " (" + e.what() + ")";
  } catch (...) {
    message = failed;
  }
  if (!message.empty()) sent = send_parcel(socket, {kFailure, -1}, message);
  if (__gcov_dump != nullptr) __gcov_dump();
  _exit(sent ? 0 : 1);
}

struct Received {
  Head head;
  Parcel parcel;
};

// Nothing where the child has ended before it has sent all.
std::optional<Received> receive(int socket, pid_t child) {
  std::string all;
  std::array<char, 4096> buffer;
  for (;;) {
    const ssize_t got = recv(socket, buffer.data(), buffer.size(), 0);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 || all.size() > kLongestText) return std::nullopt;
    if (got == 0) break;
    all.append(buffer.data(), static_cast<size_t>(got));
  }
  Received received{};
  if (all.size() < sizeof received.head) return std::nullopt;
  std::memcpy(&received.head, all.data(), sizeof received.head);
  const Head head = received.head;
  if (head.kind != kResult && head.kind != kFailure) return std::nullopt;
  if (head.bytes >= 0) received.parcel.bytes = SharedBytes::received(head.bytes, child);
  received.parcel.text = all.substr(sizeof head);
  return received;
}

std::string cause_of(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU) {
    return " (it takes too much time)";
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) return " (the system has ended it)";
  return " (a library has failed)";
}

}  // namespace

Parcel apart(const std::string& name, const std::string& what, const ApartLimits& limits,
             const std::function<Parcel()>& work) {
  const std::string failed = name + ": " + what;
  const auto system_failure = [&] {
    return Failure{failed + " (" + std::generic_category().message(errno) + ")"};
  };
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) throw system_failure();
  Descriptor here(ends[0]);
  Descriptor there(ends[1]);
  const pid_t parent = getpid();
  const pid_t id = fork_unhandled(Interrupts::kIgnored);
  if (id < 0) throw system_failure();
  if (id == 0) {
    here.reset();
    run_child(parent, there.get(), failed, limits, work);
  }
  Child child(id);
  there.reset();
  std::optional<Received> received;
  try {
    received = receive(here.get(), id);
  } catch (const std::bad_alloc&) {
    throw Failure{failed + " (not enough memory)"};
  }
  here.reset();
  const int status = child.wait();
  const bool ended = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  if (!ended || !received) {
    throw Failure{failed + cause_of(status)};
  }
  if (received->head.kind == kFailure) throw Failure{received->parcel.text};
  return std::move(received->parcel);
}

void raise_limits(const ApartLimits& more) {
  if (!has_limits) return;
  add_to_soft_limit(RLIMIT_CPU, whole_seconds(more.seconds));
#if PELLICLE_LIMITS_MEMORY
  add_to_soft_limit(RLIMIT_AS, more.bytes);
#endif
}

}  // namespace plc::tools
