#include "tools/cohort/child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "tools/file/failure.h"
#include "tools/file/fork.h"

namespace plc::tools {
namespace {

constexpr int kCannotRun = 127;

std::vector<char*> arguments_of(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  return arguments;
}

double seconds_of(const timeval& time) {
  constexpr double kMicrosecond = 1e-6;
  return static_cast<double>(time.tv_sec) + kMicrosecond * static_cast<double>(time.tv_usec);
}

}  // namespace

int start_child(const std::vector<std::string>& words, const std::string& log, int kept) {
  const std::vector<char*> arguments = arguments_of(words);
  const pid_t parent = getpid();
  const pid_t child = fork_unhandled(Interrupts::kDefault);
  if (child < 0) {
    throw Failure{words[0] + ": cannot be started: " + std::generic_category().message(errno)};
  }
  if (child > 0) return child;
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(kCannotRun);
  const int in = open("/dev/null", O_RDONLY);
  const int out = open("/dev/null", O_WRONLY);
  const int error = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (in < 0 || out < 0 || error < 0) _exit(kCannotRun);
  if (dup2(in, STDIN_FILENO) < 0 || dup2(out, STDOUT_FILENO) < 0 || dup2(error, STDERR_FILENO) < 0)
    _exit(kCannotRun);
  if (kept >= 0) (void)fcntl(kept, F_SETFD, 0);
  execv(arguments[0], arguments.data());
  _exit(kCannotRun);
}

bool has_ended(int child, ChildEnd& end) {
  int status = 0;
  struct rusage usage {};
  pid_t ended = 0;
  do {
    ended = wait4(child, &status, WNOHANG, &usage);
  } while (ended < 0 && errno == EINTR);
  if (ended == 0) return false;
  constexpr int64_t kKibibyte = 1024;
  end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  end.code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  end.cpu_seconds = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  end.peak_bytes = usage.ru_maxrss * kKibibyte;
  return true;
}

std::vector<std::string> lines_of(const std::string& log) {
  constexpr size_t kMostLines = 100;
  constexpr size_t kLongest = 1000;
  const std::string mark = "pellicle: ";
  std::vector<std::string> lines;
  std::ifstream file(log);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with(mark)) line.erase(0, mark.size());
    std::replace(line.begin(), line.end(), '\t', ' ');
    if (line.empty()) continue;
    if (lines.size() == kMostLines) lines.erase(lines.begin());
    lines.push_back(line.substr(0, kLongest));
  }
  return lines;
}

int run_program(const std::vector<std::string>& words, std::string& output) {
  output.clear();
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return kCannotRun;
  const std::vector<char*> arguments = arguments_of(words);
  const pid_t child = fork_unhandled(Interrupts::kDefault);
  if (child == 0) {
    if (dup2(ends[1], STDOUT_FILENO) >= 0) execvp(arguments[0], arguments.data());
    _exit(kCannotRun);
  }
  close(ends[1]);
  std::array<char, 4096> block{};
  for (;;) {
    const ssize_t count = read(ends[0], block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    output.append(block.data(), static_cast<size_t>(count));
  }
  close(ends[0]);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return child > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : kCannotRun;
}

std::string own_program() {
  std::array<char, 4096> path{};
  const ssize_t size = readlink("/proc/self/exe", path.data(), path.size());
  if (size <= 0) throw Failure{"/proc/self/exe: cannot be read"};
  return {path.data(), static_cast<size_t>(size)};
}

std::string quoted(const std::string& word) {
  const std::string plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=:,@%+";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) {
    if (c == '\'') text += "'\\'";
    text += c;
  }
  return text + "'";
}

}  // namespace plc::tools
