// A child process that runs none of this process's signal handlers.
#pragma once
#include <sys/types.h>

namespace plc::tools {

// SIGINT, SIGTERM, SIGHUP and SIGPIPE in the child. kDefault: as if this process did not handle
// them; those that it ignores the child does, too.
enum class Interrupts { kDefault, kIgnored };

// As fork(). A handler would speak for this process, remove its temporaries, or take a signal that
// is meant for a program that the child has not become yet. Signals that come in between wait until
// the child no longer handles them.
pid_t fork_unhandled(Interrupts interrupts);

}  // namespace plc::tools
