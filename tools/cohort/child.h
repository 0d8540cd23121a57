// `pellicle extract` as a process of its own: a scan that crashes it, or for which there is not
// enough memory, ends no more than that.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace plc::tools {

// How it has ended.
struct ChildEnd {
  int code = 0;    // its exit code, where there is no signal
  int signal = 0;  // 0: it has ended by itself
  double cpu_seconds = 0;
  int64_t peak_bytes = 0;
};

// The words of a command line, with the program's path first. Its stdin is empty, its stdout is
// dropped, its stderr goes to the file `log`, and `kept` is a descriptor that it keeps open; -1:
// none. It gets SIGTERM when this process ends. Throws Failure.
int start_child(const std::vector<std::string>& words, const std::string& log, int kept);

// Whether it has ended; does not wait.
bool has_ended(int child, ChildEnd& end);

// What it has said, each line without "pellicle: " before it; the last of very many.
std::vector<std::string> lines_of(const std::string& log);

// Runs a program to its end, its stdout kept, its stderr ours. The exit code; 127 where it cannot
// be run.
int run_program(const std::vector<std::string>& words, std::string& output);

// Of this process's program.
std::string own_program();

// As a shell takes it.
std::string quoted(const std::string& word);

}  // namespace plc::tools
