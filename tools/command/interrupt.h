// Ctrl-C, SIGTERM, SIGHUP and SIGPIPE, so that none leaves a partial output.
#pragma once

namespace plc::tools {

constexpr int kExitInterrupted = 130;

// From the first one on, for good, these signals do what it was told last: at first, end_at_once().
// Ending is a line on stderr, but none where the reader of a pipe has gone, which is told to
// nobody; the temporary files of output files are removed. SIGHUP stays ignored where it is
// (nohup). One at a time.
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
