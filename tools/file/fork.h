// A child process that runs none of this process's signal handlers.
#pragma once
#include <sys/types.h>

namespace plc::tools {

// What becomes of SIGINT, SIGTERM, SIGHUP and SIGPIPE in the child where this process handles them.
enum class Caught { kEnd, kIgnored };

// As fork(). A handler would speak for this process, remove its temporaries, or take a signal that
// is meant for a program that the child has not become yet. Signals that come in between wait until
// the child no longer handles them.
pid_t fork_unhandled(Caught caught);

}  // namespace plc::tools
