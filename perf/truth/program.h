// The main() of the programs of a scene.
#pragma once
#include <algorithm>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>
#include <vector>

#include "perf/truth/scene.h"
#include "tools/file/failure.h"

namespace truth {

inline int threads() {
  return static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1U, 8U));
}

// run(words) with the words of the command line; errors are one line on stderr and exit code 2.
template <typename Run>
int run_program(int argc, char** argv, const char* name, const char* help, const Run& run) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (std::find(words.begin(), words.end(), "--help") != words.end()) {
    std::printf("%s\n%s\n", help, kSceneHelp);
    return 0;
  }
  try {
    run(words);
    return 0;
  } catch (const plc::tools::Failure& failure) {
    std::fprintf(stderr, "%s: %s\n", name, failure.message.c_str());
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", name, e.what());
  }
  return 2;
}

}  // namespace truth
