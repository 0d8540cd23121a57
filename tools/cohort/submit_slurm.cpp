#include "tools/cohort/submit_slurm.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <iterator>
#include <sstream>
#include <system_error>

#include "tools/cohort/child.h"
#include "tools/cohort/cohort_progress.h"
#include "tools/cohort/scan_state.h"
#include "tools/cohort/slurm.h"
#include "tools/cohort/survey.h"
#include "tools/file/failure.h"
#include "tools/file/folder.h"

namespace plc::tools {
namespace {

namespace fs = std::filesystem;

constexpr double kMinute = 60;
constexpr int kPilots = 3;  // are tried before it is given up

// Of the node that has the most, in the partition that the options name; a job of more waits for
// ever. 0 where sinfo does not tell.
int most_cores(const std::vector<std::string>& options) {
  std::vector<std::string> words = {"sinfo", "--noheader", "--Node", "--format=%c"};
  std::copy_if(options.begin(), options.end(), std::back_inserter(words),
               [](const std::string& option) { return option.starts_with("--partition="); });
  std::string nodes;
  if (run_program(words, nodes) != 0) return 0;
  int most = 0;
  std::istringstream counts(nodes);
  for (int cores = 0; counts >> cores;) most = std::max(most, cores);
  return most;
}

class Submission {
 public:
  Submission(const SubmitOptions& options, const Manifest& manifest)
      : options_(options), manifest_(manifest), folder_(fs::absolute(options.folder)) {
    folder_ = folder_.lexically_normal();
    look();
  }

  void run() {
    if (left_.empty()) {
      std::printf("nothing is left to do\n");
      return;
    }
    for (int i = 0; survey_.done == 0 && !left_.empty(); ++i) {
      if (i == kPilots) throw Failure{"the pilot scans have failed, the last one: " + error_};
      if (!pilot()) return;
    }
    if (left_.empty()) {
      std::printf("nothing is left to do\n");
      return;
    }
    size();
    submit();
  }

 private:
  void look() {
    survey_ = survey_of(folder_, manifest_, std::time(nullptr));
    left_ = survey_.left;
    if (options_.retry_failed && tried_.empty()) {
      for (const Scan& scan : manifest_.scans) {
        if (result_of(folder_, scan).state == ScanState::kFailed) left_.push_back(&scan);
      }
    }
  }

  // The largest scan, alone on a node. False: it has only been printed.
  bool pilot() {
    const Scan* largest = *std::max_element(
        left_.begin(), left_.end(),
        [](const Scan* a, const Scan* b) { return a->stamp.bytes < b->stamp.bytes; });
    const std::string names = new_submission(folder_) + ".txt";
    std::vector<std::string> words = {"srun", "--job-name=pellicle-pilot", "--ntasks=1",
                                      "--cpus-per-task=1"};
    words.insert(words.end(), options_.slurm.begin(), options_.slurm.end());
    words.insert(words.end(), {own_program(), "cohort", "run", folder_, "--scans=" + names,
                               "--threads=1", "--retry-failed"});
    std::printf("%s\n", line_of(words).c_str());
    std::fflush(stdout);
    if (options_.dry_run) {
      std::printf(
          "# No scan is done yet. This pilot would run %s, and its seconds and memory\n"
          "# would size the array.\n",
          largest->name.c_str());
      return false;
    }
    make_folder(folder_.string() + "/submitted");
    write_text(names, largest->name + "\n");
    std::string output;
    const int code = run_program(words, output);
    tried_.push_back(largest->name);
    const ScanResult result = result_of(folder_, *largest);
    if (result.state == ScanState::kLeft) {
      throw Failure{"srun: ends with exit code " + std::to_string(code) +
                    ", and the pilot scan is not done"};
    }
    error_ = result.report.value("error", "");
    look();
    return true;
  }

  // From what is done, as it would be on one core.
  void size() {
    const double task = options_.minutes * kMinute;
    double mean = std::max(survey_.mean_seconds, survey_.mean_cpu_seconds);
    double longest = std::max(survey_.longest_seconds, survey_.longest_cpu_seconds);
    // Scans apart use cores best; only where one does not fit in a task it gets several.
    cores_ = options_.cores > 0
                 ? options_.cores
                 : std::max(1, static_cast<int>(std::min(std::ceil(longest / task), 1e6)));
    const int most_of_node = most_cores(options_.slurm);
    if (options_.cores == 0 && most_of_node > 0 && cores_ > most_of_node) {
      std::printf("# no node has more than %d cores: some scans take longer than %g minutes\n",
                  most_of_node, options_.minutes);
      cores_ = most_of_node;
    }
    mean = std::max(mean / cores_, 0.01);
    longest /= cores_;
    per_task_ = std::max<size_t>(1, static_cast<size_t>(task / mean));
    tasks_ = (left_.size() + per_task_ - 1) / per_task_;
    const size_t most = most_array_tasks();
    if (tasks_ > most) {
      std::printf("# MaxArraySize allows %zu tasks: each takes longer than %g minutes\n", most,
                  options_.minutes);
      tasks_ = most;
    }
    per_task_ = (left_.size() + tasks_ - 1) / tasks_;
    seconds_ = mean * static_cast<double>(per_task_);
    // A task that is late is ended, and what it has not done can be submitted again.
    constexpr double kMargin = 1.5;
    constexpr double kLongest = 2;
    constexpr double kSpare = 3;
    minutes_ = std::ceil(kMargin * seconds_ / kMinute + kLongest * longest / kMinute + kSpare);
    // Larger scans than those that are done need more.
    uint64_t largest = survey_.largest_input;
    for (const Scan* scan : left_) largest = std::max(largest, scan->stamp.bytes);
    constexpr double kMebibyte = 1024.0 * 1024.0;
    constexpr double kRoom = 1.25;
    constexpr double kStep = 64;
    const double ratio = static_cast<double>(largest) /
                         static_cast<double>(std::max<uint64_t>(survey_.largest_input, 1));
    const double bytes = static_cast<double>(survey_.peak_bytes) * ratio * kRoom;
    mebibytes_ = (std::ceil(bytes / kMebibyte / kStep) + 1) * kStep;
  }

  std::string script(const std::string& names) const {
    std::ostringstream text;
    text << slurm_head({"pellicle", "1-" + std::to_string(tasks_), cores_,
                        static_cast<int64_t>(mebibytes_), static_cast<int64_t>(minutes_),
                        folder_.string() + "/logs/%A_%a.log", options_.slurm});
    text << "exec " << line_of({own_program(), "cohort", "run", folder_, "--scans=" + names})
         << " --task=\"$SLURM_ARRAY_TASK_ID/" << tasks_ << "\" --threads=" << cores_
         << (options_.retry_failed ? " --retry-failed" : "") << "\n";
    return text.str();
  }

  void submit() {
    const std::string base = new_submission(folder_);
    const std::string names = base + ".txt", file = base + ".sh";
    std::string list;
    for (const Scan* scan : left_) list += scan->name + "\n";
    const std::string text = script(names);
    const std::vector<std::string> words = {"sbatch", "--parsable", file};
    std::printf("# %zu scans in %zu tasks of %zu, about %s each\n%s\n", left_.size(), tasks_,
                per_task_, duration_text(seconds_).c_str(), line_of(words).c_str());
    std::printf("# %s:\n%s", file.c_str(), text.c_str());
    std::fflush(stdout);
    if (options_.dry_run) return;
    make_folder(folder_.string() + "/submitted");
    make_folder(folder_.string() + "/logs");
    write_text(names, list);
    write_text(file, text);
    std::string job;
    try {
      job = submit_job(words);
    } catch (...) {
      std::error_code none;
      fs::remove(names, none);
      fs::remove(file, none);
      throw;
    }
    std::printf("# submitted as job %s; pellicle cohort status %s\n", job.c_str(),
                quoted(folder_).c_str());
  }

  const SubmitOptions& options_;
  const Manifest& manifest_;
  fs::path folder_;
  Survey survey_;
  std::vector<const Scan*> left_;
  std::vector<std::string> tried_;  // as pilots
  std::string error_;               // of the last pilot
  int cores_ = 1;
  size_t per_task_ = 1, tasks_ = 1;
  double seconds_ = 0;    // of a task, expected
  double minutes_ = 0;    // that it may take
  double mebibytes_ = 0;  // that it may have
};

}  // namespace

void submit_slurm(const SubmitOptions& options, const Manifest& manifest) {
  Submission(options, manifest).run();
}

}  // namespace plc::tools
