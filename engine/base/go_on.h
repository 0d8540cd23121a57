// Asked by what takes seconds, between its parts.
#pragma once
#include <functional>

#include "pyramid/status.h"

namespace plc {

// Whether to go on; may be empty: yes. On the calling thread.
using GoOn = std::function<bool()>;

// kCancelled where not.
inline Status ask(const GoOn& go_on) {
  if (!go_on || go_on()) return {};
  return {ErrorCode::kCancelled, "cancelled"};
}

}  // namespace plc
