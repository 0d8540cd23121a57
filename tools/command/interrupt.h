// Ctrl-C, SIGTERM, SIGHUP and SIGPIPE, so that none leaves a partial output.
#pragma once

namespace plc::tools {

constexpr int kExitInterrupted = 130;

// From the first guard on and until the process ends, these signals do what the last call of a
// guard chose; at first that is end_at_once(). A process that ends by one writes a line to stderr -
// not for SIGPIPE: nobody reads on - and removes the temporary files of its outputs. SIGHUP stays
// ignored where it is (nohup). There is one guard at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  // From now on a signal ends the process at once (there is nothing to undo), the first one is
  // noted and the second ends it, or all are only noted.
  void end_at_once();
  void note_first();
  void only_note();

  bool interrupted() const;
  // That a noted signal ends the process; the exit code.
  int tell() const;
  // Whether SIGPIPE has come.
  bool pipe_closed() const;
};

}  // namespace plc::tools
