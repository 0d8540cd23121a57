// Ctrl-C and SIGTERM, so that neither leaves a partial output.
#pragma once

namespace plc::tools {

constexpr int kExitInterrupted = 130;

// While one lives, SIGINT and SIGTERM do what it was told last: at first, note_first().
// One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  // From now on a signal ends the process at once (there is nothing to undo), the first one is
  // noted and the second ends it, or all are only noted.
  void end_at_once();
  void note_first();
  void only_note();

  bool interrupted() const;
};

}  // namespace plc::tools
