// Work that others' libraries do on files that may have been made to do harm - they abort, and loop
// without end - in a child process with limits, where that harms nobody.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "tools/file/shared_bytes.h"

namespace plc::tools {

struct ApartLimits {
  double seconds;  // of processor time
  uint64_t bytes;  // of memory, beside what the process has already; not held to by sanitizers
};

// What the child sends back.
struct Parcel {
  std::string text;  // at most 1 MiB
  SharedBytes bytes;
};

// Runs the work in a child and returns what it returns. The child is silent, does not outlive this
// process, and leaves signals that interrupt to it. Throws Failure: what the work has thrown, or
// "NAME: WHAT (why)" where the child has died, met a limit, or thrown anything else. The process
// must have no other thread: one that holds a lock while it is forked holds it in the child for
// ever.
Parcel apart(const std::string& name, const std::string& what, const ApartLimits& limits,
             const std::function<Parcel()>& work);

// Called by the work where it knows more about what it has to do: so much is added to the limits.
// Outside of apart() it does nothing.
void raise_limits(const ApartLimits& more);

}  // namespace plc::tools
