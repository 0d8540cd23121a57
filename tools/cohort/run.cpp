#include "tools/cohort/run.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <deque>
#include <fstream>
#include <list>
#include <map>
#include <set>
#include <thread>
#include <utility>

#include "tools/cohort/child.h"
#include "tools/cohort/claim.h"
#include "tools/cohort/cohort_progress.h"
#include "tools/cohort/publish.h"
#include "tools/cohort/scan_state.h"
#include "tools/file/failure.h"
#include "tools/file/memory.h"
#include "tools/file/printable.h"

namespace plc::tools {
namespace {

constexpr int kInterrupted = 130;  // the exit code of a child that a signal has ended
constexpr auto kPoll = std::chrono::milliseconds(5);
constexpr auto kPollOthers = std::chrono::milliseconds(200);

struct Running {
  const Scan* scan;
  Claim claim;
  int child;
  double start;
};

std::string signal_text(int signal) {
  if (signal == SIGKILL) return "was killed (signal 9), perhaps for want of memory";
  return "was ended by signal " + std::to_string(signal);
}

class Runner {
 public:
  Runner(const RunOptions& options, const Manifest& manifest,
         const std::function<bool()>& interrupted)
      : options_(options),
        manifest_(manifest),
        interrupted_(interrupted),
        todo_(share()),
        progress_("scans done", todo_.size(), options.quiet) {
    if (options.jobs > 1) {
      threads_ = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / options.jobs);
    }
    if (options.threads > 0) threads_ = options.threads;
    memory_ = options.memory > 0 ? options.memory : available_memory();
  }

  RunEnd run() {
    while (!interrupted_() && !(todo_.empty() && running_.empty() && others_.empty())) {
      bool idle = todo_.empty() || !has_room();
      if (!idle) start_next();
      if (reap()) idle = false;
      if (idle) std::this_thread::sleep_for(running_.empty() ? kPollOthers : kPoll);
      // What others were making may be done by now, or they have ended.
      if (todo_.empty() && running_.empty()) std::swap(todo_, others_);
    }
    for (const Running& r : running_) kill(r.child, SIGTERM);
    while (!running_.empty()) {
      if (!reap()) std::this_thread::sleep_for(kPoll);
    }
    end_.left += todo_.size() + others_.size();
    end_.seconds = progress_.seconds();
    return end_;
  }

 private:
  std::deque<const Scan*> share() {
    std::deque<const Scan*> todo;
    const std::vector<const Scan*> chosen = chosen_scans(manifest_, options_.scans);
    const auto parts = static_cast<size_t>(options_.parts);
    for (size_t i = static_cast<size_t>(options_.part) - 1; i < chosen.size(); i += parts) {
      const ScanResult result = result_of(options_.folder, *chosen[i]);
      const bool again = result.state == ScanState::kFailed && options_.retry_failed;
      if (result.state == ScanState::kLeft || again) {
        todo.push_back(chosen[i]);
        continue;
      }
      if (result.state == ScanState::kDone) note_peak(result);
      ++end_.skipped;
      if (result.state == ScanState::kDone && has_changed(*chosen[i], true)) {
        end_.changed.push_back(chosen[i]->name);
      }
    }
    return todo;
  }

  // Whether an input is not what has been planned. Of one that is done and has gone nobody asks.
  static bool has_changed(const Scan& scan, bool done) {
    try {
      if (done && stamp_of(scan.input) == scan.stamp) return false;
      return hash_of(scan.input) != scan.hash;
    } catch (const Failure&) {
      if (done) return false;
      throw;
    }
  }

  void note_peak(const ScanResult& result) {
    peak_ = std::max(peak_, result.report["cohort"].value("peak_rss_bytes", uint64_t{0}));
  }

  // The first scan runs alone and tells what one needs.
  bool has_room() const {
    if (running_.empty()) return true;
    const size_t next = running_.size() + 1;
    return next <= static_cast<size_t>(options_.jobs) && peak_ > 0 &&
           (memory_ == 0 || next * peak_ <= memory_);
  }

  void start_next() {
    const Scan& scan = *todo_.front();
    todo_.pop_front();
    Claim claim;
    if (!claim.take(work_path(options_.folder, scan))) {
      others_.push_back(&scan);
      return;
    }
    // Another may have made it since.
    const ScanResult result = result_of(options_.folder, scan);
    if (result.state == ScanState::kDone) {
      ++end_.skipped;
      claim.finish();
      return;
    }
    try {
      if (has_changed(scan, false)) {
        throw Failure{scan.input + ": has changed since the plan; plan again"};
      }
    } catch (const Failure& failure) {
      fail(scan, {}, failure.message);
      claim.finish();
      return;
    }
    const std::string log = work_path(options_.folder, scan) + "/stderr";
    const int child = start_child(words_of(scan), log, claim.descriptor());
    running_.push_back({&scan, std::move(claim), child, progress_.seconds()});
  }

  std::vector<std::string> words_of(const Scan& scan) const {
    std::vector<std::string> words = {"/proc/self/exe", "extract", "--quiet"};
    if (manifest_.labels) {
      words.push_back("--labels=" + scan.input);
    }
    words.push_back("--output=" + staged_mesh(options_.folder, scan, manifest_));
    words.push_back("--report=" + staged_report(options_.folder, scan));
    bool has_threads = false;
    for (const std::string& word : scan.options) {
      const bool threads = word.starts_with("--threads=");
      has_threads = has_threads || threads;
      if (!(threads && options_.threads > 0)) words.push_back(word);
    }
    if (threads_ > 0 && (!has_threads || options_.threads > 0)) {
      words.push_back("--threads=" + std::to_string(threads_));
    }
    if (!manifest_.labels) {
      words.push_back("--");
      words.push_back(scan.input);
    }
    return words;
  }

  // Whether one has ended.
  bool reap() {
    bool any = false;
    for (auto i = running_.begin(); i != running_.end();) {
      ChildEnd end;
      if (!has_ended(i->child, end)) {
        ++i;
        continue;
      }
      settle(*i, end);
      i = running_.erase(i);
      any = true;
    }
    return any;
  }

  void settle(Running& r, const ChildEnd& end) {
    const Scan& scan = *r.scan;
    const ScanRun run{end, progress_.seconds() - r.start,
                      lines_of(work_path(options_.folder, scan) + "/stderr")};
    peak_ = std::max(peak_, static_cast<uint64_t>(end.peak_bytes));
    // A scheduler that ends this task kills its processes one after the other: we may be next.
    if (end.signal == SIGKILL) std::this_thread::sleep_for(std::chrono::seconds(1));
    if (end.code == kInterrupted || (end.signal != 0 && interrupted_())) {
      ++end_.left;
    } else if (end.signal != 0) {
      fail(scan, run, signal_text(end.signal));
    } else if (end.code != 0) {
      fail(
          scan, run,
          run.lines.empty() ? "ends with exit code " + std::to_string(end.code) : run.lines.back());
    } else {
      finish(scan, run);
    }
    r.claim.finish();
  }

  // Where its files cannot be put into their place that is noted - or nothing can be written there.
  void finish(const Scan& scan, const ScanRun& run) {
    try {
      publish(options_.folder, manifest_, scan, run);
      ++end_.done;
      tell_progress();
    } catch (const Failure& failure) {
      fail(scan, run, failure.message);
    }
  }

  void fail(const Scan& scan, const ScanRun& run, const std::string& error) {
    note_failure(options_.folder, scan, run, error);
    ++end_.failed;
    progress_.tell(scan.name + ": " + error);
    tell_progress();
  }

  void tell_progress() {
    progress_.update(end_.done + end_.failed,
                     end_.failed > 0 ? ", " + std::to_string(end_.failed) + " failed" : "");
  }

  const RunOptions& options_;
  const Manifest& manifest_;
  const std::function<bool()>& interrupted_;
  RunEnd end_;
  uint64_t peak_ = 0;  // bytes of the largest scan so far
  int threads_ = 0;
  uint64_t memory_ = 0;
  std::deque<const Scan*> todo_;
  std::deque<const Scan*> others_;  // that another run is making
  std::list<Running> running_;
  CohortProgress progress_;
};

}  // namespace

std::vector<const Scan*> chosen_scans(const Manifest& manifest, const std::string& names) {
  std::vector<const Scan*> chosen;
  std::set<std::string> wanted;
  if (!names.empty()) {
    std::ifstream file(names);
    if (!file) throw Failure{names + ": cannot be read"};
    for (std::string line; std::getline(file, line);) {
      if (!line.empty()) wanted.insert(line);
    }
  }
  for (const Scan& scan : manifest.scans) {
    if (names.empty() || wanted.erase(scan.name) > 0) chosen.push_back(&scan);
  }
  if (!wanted.empty()) {
    throw Failure{names + ": " + printable(*wanted.begin()) + " is no scan of the cohort"};
  }
  return chosen;
}

RunEnd run_cohort(const RunOptions& options, const Manifest& manifest,
                  const std::function<bool()>& interrupted) {
  return Runner(options, manifest, interrupted).run();
}

}  // namespace plc::tools
