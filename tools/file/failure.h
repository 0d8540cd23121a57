// How the tools say that something cannot be done.
#pragma once
#include <string>

namespace plc::tools {

// What a command reports to its user: one line, without a newline.
struct Failure {
  std::string message;
};

}  // namespace plc::tools
