// The clock of what commands tell: seconds since some time, never going back.
#pragma once
#include <chrono>

namespace plc::tools {

inline double now() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

}  // namespace plc::tools
