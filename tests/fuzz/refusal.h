// What a reader may do with bytes: read them, or refuse them in one line that names the file.
#pragma once
#include <algorithm>
#include <string>

#include "tests/fuzz/input.h"
#include "tools/file/failure.h"

namespace fuzz {

inline void check_message(const std::string& message, const std::string& path) {
  constexpr size_t kLongest = 600;
  require(message.starts_with(path), "a message that does not name its file: " + message);
  require(message.size() > path.size() + 2 && message.size() < kLongest,
          "a message of a strange length: " + message);
  require(std::none_of(message.begin(), message.end(),
                       [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }),
          "a message of more than a line: " + message);
}

template <typename Work>
void read_or_refuse(const std::string& path, const Work& work) {
  try {
    work();
  } catch (const plc::tools::Failure& failure) {
    check_message(failure.message, path);
  }
}

}  // namespace fuzz
