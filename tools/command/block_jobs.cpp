#include "tools/command/block_jobs.h"

#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/blocks/block_plan.h"
#include "tools/blocks/block_survey.h"
#include "tools/file/failure.h"

namespace plc::tools {

namespace {

using Json = nlohmann::ordered_json;

bool stdin_is_closed() {
  pollfd in{STDIN_FILENO, 0, 0};
  return poll(&in, 1, 0) > 0 && (in.revents & (POLLHUP | POLLERR)) != 0;
}

// Throws Failure.
void read_task(const std::string& line, const BlockPlan& plan, int& step, int64_t& block) {
  std::istringstream words(line);
  std::string rest;
  if (!(words >> step >> block) || words >> rest || step < 0 || step >= plan.steps() || block < 0 ||
      block >= plan.grid.block_count() ||
      BlockGrid::colour_of(plan.grid.block_at(block)) != step % BlockGrid::kColours) {
    throw Failure{"--serve: no task of the plan, STEP and BLOCK: " + line};
  }
}

}  // namespace

void add_block_folder(CLI::App& app, std::string& folder) {
  app.add_option("DIR", folder, "Folder of a plan by blocks")->required()->type_name("");
}

void add_block_status(CLI::App& app, BlockOptions& options) {
  add_block_folder(app, options.folder);
  app.add_flag("--json", options.json, "JSON instead of lines, with the blocks that are left");
}

void add_block_submit(CLI::App& app, BlockOptions& options) {
  BlockSubmit& submit = options.submit;
  app.add_option_function<std::string>(
         "SCHEDULER",
         [](const std::string& s) {
           if (s != "slurm") refuse_value("SCHEDULER", s, "slurm");
         },
         "slurm")
      ->required()
      ->type_name("");
  add_block_folder(app, submit.folder);
  app.add_option_function<std::string>(
         "--cores", [&submit](const std::string& s) { submit.cores = at_least(1, "--cores", s); },
         "Cores of a task")
      ->type_name("N")
      ->default_str("1");
  app.add_option_function<std::string>(
         "--memory", [&submit](const std::string& s) { submit.memory = to_bytes("--memory", s); },
         "Memory of a task, as in 4G")
      ->type_name("SIZE")
      ->default_str("4G");
  app.add_option_function<std::string>(
         "--minutes",
         [&submit](const std::string& s) { submit.minutes = above_zero("--minutes", s); },
         "What a block may take at most, above 0")
      ->type_name("M")
      ->default_str("60");
  app.add_option("--option", submit.slurm,
                 "Further option of sbatch, as in --option=--partition=long. May be given several "
                 "times")
      ->type_name("OPTION")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_flag("--dry-run", submit.dry_run, "Only print what would be run");
}

int run_block_status(const BlockOptions& options) {
  const BlockPlan plan = read_plan(options.folder);
  const std::time_t now = std::time(nullptr);
  const BlockSurvey survey = survey_of(options.folder, plan, now);
  const std::string text =
      options.json ? status_json(survey, plan, now) : status_text(survey, plan, now);
  std::fputs(text.c_str(), stdout);
  return survey.left > 0 ? 1 : 0;
}

int run_block_submit(const BlockOptions& options) {
  submit_blocks(options.submit, read_plan(options.submit.folder));
  return 0;
}

int serve_tasks(BlockTasks& tasks, InterruptGuard& interrupt) {
  for (std::string line;;) {
    interrupt.end_at_once();
    if (!std::getline(std::cin, line)) return 0;
    int step = 0;
    int64_t block = 0;
    read_task(line, tasks.plan(), step, block);
    interrupt.note_first();
    const auto gone = [&] { return interrupt.interrupted() || stdin_is_closed(); };
    std::string answer;
    try {
      TaskRecord record;
      const std::string path =
          block_path(tasks.folder(), tasks.plan(), step, tasks.plan().grid.block_at(block));
      if (tasks.done(step, block)) {
        record = read_record(path).value_or(TaskRecord{});
      } else if (!tasks.run(step, block, gone, record)) {
        return interrupt.tell();
      }
      answer = record_text(record);
    } catch (const Failure& failure) {
      answer =
          Json{{"error", failure.message}}.dump(-1, ' ', false, Json::error_handler_t::replace);
    }
    std::printf("%s\n", answer.c_str());
    std::fflush(stdout);
    if (interrupt.interrupted()) return interrupt.tell();
  }
}

}  // namespace plc::tools
