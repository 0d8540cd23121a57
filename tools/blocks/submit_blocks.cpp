#include "tools/blocks/submit_blocks.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <set>

#include "tools/blocks/block_survey.h"
#include "tools/cohort/child.h"
#include "tools/cohort/slurm.h"
#include "tools/file/failure.h"
#include "tools/file/folder.h"

namespace plc::tools {

namespace {

namespace fs = std::filesystem;

class BlockSubmission {
 public:
  BlockSubmission(const BlockSubmit& options, const BlockPlan& plan)
      : options_(options),
        plan_(plan),
        folder_(fs::absolute(options.folder).lexically_normal().string()),
        most_(most_array_tasks()) {
    if (folder_.size() > 1 && folder_.ends_with('/')) folder_.pop_back();
  }

  void run() {
    const BlockSurvey survey = survey_of(folder_, plan_, std::time(nullptr));
    if (survey.left == 0) {
      std::printf("nothing is left to do\n");
      return;
    }
    size_t largest = 1;
    for (const StepSurvey& step : survey.steps) {
      if (!step.left.empty()) largest = std::max(largest, per_share(step));
    }
    const std::string text = script(largest);
    file_ = new_submission(folder_) + ".sh";
    std::printf("# %" PRId64 " of %" PRId64 " tasks are left\n# %s:\n%s", survey.left, survey.tasks,
                file_.c_str(), text.c_str());
    if (largest > 1) {
      std::printf("# MaxArraySize allows %zu tasks: each has up to %zu blocks\n", most_, largest);
    }
    std::fflush(stdout);
    if (!options_.dry_run) {
      make_folder(folder_ + "/submitted");
      make_folder(folder_ + "/logs");
      write_text(file_, text);
    }
    try {
      for (int step = 0; step < plan_.steps(); ++step) {
        const StepSurvey& own = survey.steps[static_cast<size_t>(step)];
        if (!own.left.empty()) submit(step, own);
      }
    } catch (const Failure&) {
      take_back();
      throw;
    }
    if (options_.dry_run) return;
    std::printf("# submitted as jobs %s to %s; pellicle blocks status %s\n", jobs_.front().c_str(),
                jobs_.back().c_str(), line_of({folder_}).c_str());
  }

 private:
  size_t shares(const StepSurvey& step) const {
    return std::min(most_, static_cast<size_t>(step.tasks));
  }
  size_t per_share(const StepSurvey& step) const {
    const size_t count = shares(step);
    return (static_cast<size_t>(step.tasks) + count - 1) / count;
  }

  std::string script(size_t blocks) const {
    constexpr int64_t kMebibyte = int64_t{1} << 20;
    SlurmNeeds needs;
    needs.job_name = "pellicle-blocks";
    needs.cores = options_.cores;
    needs.mebibytes = (options_.memory + kMebibyte - 1) / kMebibyte;
    needs.minutes = static_cast<int64_t>(std::ceil(options_.minutes * static_cast<double>(blocks)));
    needs.log = folder_ + "/logs/%A_%a.log";
    needs.options = options_.slurm;
    // A step of which a task has failed is never done, and those after it must not wait for it.
    return slurm_head(needs) + "#SBATCH --kill-on-invalid-dep=yes\n" +
           "# Its arguments: the step, and in how many shares it is done.\nexec " +
           line_of({own_program(), "blocks", "run", folder_}) +
           " --step=\"$1\" --task=\"$SLURM_ARRAY_TASK_ID/$2\" --threads=" +
           std::to_string(options_.cores) + " --memory=" + std::to_string(options_.memory) + "\n";
  }

  void submit(int step, const StepSurvey& own) {
    const size_t count = shares(own);
    std::vector<std::string> words = {
        "sbatch", "--parsable",
        "--array=" +
            shares_left(plan_.grid.blocks_of_colour(step % BlockGrid::kColours), own.left, count)};
    if (!jobs_.empty()) words.push_back("--dependency=afterok:" + jobs_.back());
    words.insert(words.end(), {file_, std::to_string(step), std::to_string(count)});
    std::printf("%s\n", line_of(words).c_str());
    std::fflush(stdout);
    jobs_.push_back(options_.dry_run ? "JOB" + std::to_string(jobs_.size() + 1)
                                     : submit_job(words));
  }

  void take_back() const {
    std::vector<std::string> words = {"scancel"};
    words.insert(words.end(), jobs_.begin(), jobs_.end());
    if (!jobs_.empty()) {
      std::printf("%s\n", line_of(words).c_str());
      std::string none;
      run_program(words, none);
    }
    std::error_code none;
    fs::remove(file_, none);
  }

  const BlockSubmit& options_;
  const BlockPlan& plan_;
  std::string folder_;
  size_t most_;  // tasks of an array
  std::string file_;
  std::vector<std::string> jobs_;
};

}  // namespace

std::string shares_left(const std::vector<int64_t>& blocks, const std::vector<int64_t>& left,
                        size_t shares) {
  std::set<size_t> numbers;
  for (size_t i = 0; i < blocks.size(); ++i) {
    if (std::binary_search(left.begin(), left.end(), blocks[i])) numbers.insert(i % shares + 1);
  }
  std::string text;
  for (auto at = numbers.begin(); at != numbers.end();) {
    const size_t first = *at;
    size_t last = first;
    for (++at; at != numbers.end() && *at == last + 1; ++at) ++last;
    if (!text.empty()) text += ',';
    text += std::to_string(first);
    if (last > first) text.append("-").append(std::to_string(last));
  }
  return text;
}

void submit_blocks(const BlockSubmit& options, const BlockPlan& plan) {
  BlockSubmission(options, plan).run();
}

}  // namespace plc::tools
