// Numbers of the command line.
#pragma once
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "tools/file/failure.h"

namespace truth {

// Finite numbers with commas between them, `least` to `most` of them. Throws Failure, which names
// `what`.
inline std::vector<double> to_numbers(const std::string& what, const std::string& text,
                                      size_t least, size_t most) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (;;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(at, &end));
    const bool good = end != at && std::isfinite(numbers.back());
    if (good && *end == '\0') break;
    if (!good || *end != ',') numbers.resize(most + 1);
    if (numbers.size() > most) break;
    at = end + 1;
  }
  if (numbers.size() < least || numbers.size() > most) {
    const std::string count = least == most ? std::to_string(least)
                                            : std::to_string(least) + " to " + std::to_string(most);
    throw plc::tools::Failure{what + ": " + count + (most == 1 ? " number is" : " numbers are") +
                              " expected"};
  }
  return numbers;
}

}  // namespace truth
