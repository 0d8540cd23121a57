#include "tools/command/command_cohort.h"

#include <cstdio>
#include <ctime>

#include "engine/pellicle.h"
#include "tools/cohort/cohort_progress.h"
#include "tools/cohort/collect.h"
#include "tools/cohort/manifest.h"
#include "tools/cohort/survey.h"
#include "tools/command/cohort_parser.h"
#include "tools/file/failure.h"

namespace plc::tools {
namespace {

const Choices<const char*> kFormats = {
    {"ply", ".ply"}, {"stl", ".stl"}, {"obj", ".obj"},           {"off", ".off"}, {"vtp", ".vtp"},
    {"vtk", ".vtk"}, {"gii", ".gii"}, {"surf.gii", ".surf.gii"}, {"glb", ".glb"}, {"3mf", ".3mf"}};

template <typename Read>
CLI::Option* add_text(CLI::App& app, const std::string& name, const std::string& type,
                      const std::string& fallback, const std::string& meaning, const Read& read) {
  return app.add_option_function<std::string>(name, read, meaning)
      ->type_name(type)
      ->default_str(fallback);
}

void add_cohort_folder(CLI::App& app, std::string& folder) {
  app.add_option("DIR", folder, "Folder of a cohort that has been planned")
      ->required()
      ->type_name("");
}

void add_plan(CLI::App& app, CohortOptions& options) {
  PlanOptions& plan = options.plan;
  app.add_option("LIST", plan.list,
                 "Table with the columns name and input, and any option of extract as a further "
                 "one, between tabs; or a folder of images; or a BIDS tree")
      ->required()
      ->type_name("");
  add_extract_options(app, options.extract);
  app.remove_option(app.get_option("INPUT"));
  std::vector<CLI::Option*> own;
  for (CLI::Option* option : app.get_options()) {
    if (!option->get_lnames().empty() && is_own_option(option->get_lnames()[0]) &&
        option != app.get_help_ptr()) {
      own.push_back(option);
    }
  }
  for (CLI::Option* option : own) app.remove_option(option);
  app.add_option("-o,--output", plan.folder, "Folder of the cohort; made where it is not there")
      ->required()
      ->type_name("DIR")
      ->group("Cohort");
  plan.mesh_suffix = ".ply";
  add_text(app, "--format", "ply|stl|obj|off|vtp|vtk|gii|surf.gii|glb|3mf", "ply",
           "Format of the meshes",
           [&plan](const std::string& s) { plan.mesh_suffix = to_choice("--format", s, kFormats); })
      ->group("Cohort");
  app.add_flag("--labels", plan.labels, "The inputs are label images, as of extract --labels")
      ->group("Cohort");
  app.add_option("--suffix", plan.table.suffix,
                 "Of a BIDS tree: which images, by the suffix of their names, as in T1w")
      ->type_name("SUFFIX")
      ->group("Cohort");
  plan.table.description = "pellicle";
  app.add_option("--desc", plan.table.description,
                 "Of a BIDS tree: what names of derivatives have for desc")
      ->type_name("LABEL")
      ->default_str("pellicle")
      ->group("Cohort");
  app.add_flag("--quiet", plan.quiet, "No progress and no summary")->group("Cohort");
}

void add_run(CLI::App& app, RunOptions& run) {
  add_cohort_folder(app, run.folder);
  add_text(app, "--task", "I/N", "1/1", "The I-th of N shares, I from 1",
           [&run](const std::string& s) { to_share("--task", s, run.part, run.parts); });
  app.add_option("--scans", run.scans, "Only scans named in this file, a name on each line")
      ->type_name("FILE");
  app.add_flag("--retry-failed", run.retry_failed, "Run scans again that have failed");
  add_text(app, "--jobs", "N", "1",
           "Scans at once: more than the first one only when it is known what one needs",
           [&run](const std::string& s) { run.jobs = at_least(1, "--jobs", s); });
  add_text(app, "--threads", "N", "the cores divided by the jobs", "Threads of each scan",
           [&run](const std::string& s) { run.threads = at_least(1, "--threads", s); });
  add_text(app, "--memory", "GIB", "what is left", "Memory for all jobs together",
           [&run](const std::string& s) {
             constexpr double kGibibyte = 1024.0 * 1024.0 * 1024.0;
             run.memory = static_cast<uint64_t>(above_zero("--memory", s) * kGibibyte);
           });
  app.add_flag("--quiet", run.quiet, "No progress and no summary; errors of scans only");
}

void add_submit(CLI::App& app, SubmitOptions& submit) {
  app.add_option_function<std::string>(
         "SCHEDULER",
         [](const std::string& s) {
           if (s != "slurm") refuse_value("SCHEDULER", s, "slurm");
         },
         "slurm")
      ->required()
      ->type_name("");
  add_cohort_folder(app, submit.folder);
  add_text(app, "--minutes", "M", "60", "What a task is to take, above 0",
           [&submit](const std::string& s) { submit.minutes = above_zero("--minutes", s); });
  add_text(app, "--cores", "N", "1, more for scans that would not fit in a task", "Cores of a task",
           [&submit](const std::string& s) { submit.cores = at_least(1, "--cores", s); });
  app.add_option("--option", submit.slurm,
                 "Further option of sbatch and srun, as in --option=--partition=long. May be given "
                 "several times")
      ->type_name("OPTION")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_flag("--retry-failed", submit.retry_failed, "Scans that have failed, too");
  app.add_flag("--dry-run", submit.dry_run, "Only print what would be run");
}

int run_plan(const CLI::App& app, CohortOptions& options) {
  PlanOptions& plan = options.plan;
  const CohortParser parser(plan.mesh_suffix, plan.labels);
  plan.words = given_words(app, parser);
  plan.version = plc_version_string();
  const Manifest manifest = plan_cohort(plan, parser);
  if (plan.quiet) return 0;
  uint64_t bytes = 0;
  for (const Scan& scan : manifest.scans) bytes += scan.stamp.bytes;
  constexpr double kMebibyte = 1024.0 * 1024.0;
  std::printf("planned %zu scans, %.1f MiB\n", manifest.scans.size(),
              static_cast<double>(bytes) / kMebibyte);
  const std::time_t now = std::time(nullptr);
  std::fputs(status_text(survey_of(plan.folder, manifest, now), now).c_str(), stdout);
  return 0;
}

int run_share(const RunOptions& run, InterruptGuard& interrupt) {
  const Manifest manifest = read_manifest(run.folder, plc_version_string());
  interrupt.note_first();
  const RunEnd end = run_cohort(run, manifest, [&] { return interrupt.interrupted(); });
  if (!run.quiet) {
    std::printf("done %zu, failed %zu, skipped %zu, left %zu, in %s\n", end.done, end.failed,
                end.skipped, end.left, duration_text(end.seconds).c_str());
    std::fflush(stdout);
  }
  for (const std::string& name : end.changed) {
    std::fprintf(stderr, "pellicle: %s: its input has changed since the plan; plan again\n",
                 name.c_str());
  }
  if (interrupt.interrupted()) return interrupt.tell();
  return end.failed + end.changed.size() + end.left > 0 ? 1 : 0;
}

int run_status(const CohortOptions& options) {
  const Manifest manifest = read_manifest(options.folder, plc_version_string());
  const std::time_t now = std::time(nullptr);
  const Survey survey = survey_of(options.folder, manifest, now);
  std::fputs((options.json ? status_json(survey, now) : status_text(survey, now)).c_str(), stdout);
  return survey.failed + survey.left.size() > 0 ? 1 : 0;
}

int run_collect(const CohortOptions& options) {
  const Manifest manifest = read_manifest(options.folder, plc_version_string());
  const std::string path = options.table.empty() ? options.folder + "/cohort.tsv" : options.table;
  const Collected collected = collect_cohort(options.folder, manifest, path);
  std::fprintf(stderr, "%zu lines, %zu of scans that are not done\nwritten  %s\n", collected.rows,
               collected.missing, path.c_str());
  return 0;
}

}  // namespace

void add_cohort_options(CLI::App& command, CohortOptions& options) {
  command.require_subcommand(1);
  add_plan(
      *command.add_subcommand("plan", "Plan a cohort: a list of scans, and what to do with them"),
      options);
  add_run(*command.add_subcommand("run", "Extract the scans of a cohort, or a share of them"),
          options.run);
  CLI::App* status = command.add_subcommand("status", "Tell what is done, and when the rest is");
  add_cohort_folder(*status, options.folder);
  status->add_flag("--json", options.json, "JSON instead of lines");
  CLI::App* collect = command.add_subcommand("collect", "Write one table of all that is done");
  add_cohort_folder(*collect, options.folder);
  collect->add_option("-o,--output", options.table, "Table to write, columns between tabs")
      ->type_name("FILE")
      ->default_str("DIR/cohort.tsv");
  add_submit(*command.add_subcommand("submit", "Run what is left as one job array of Slurm"),
             options.submit);
}

int run_cohort_command(const CLI::App& command, CohortOptions& options, InterruptGuard& interrupt) {
  const CLI::App& verb = *command.get_subcommands()[0];
  const std::string& name = verb.get_name();
  if (name == "plan") return run_plan(verb, options);
  if (name == "run") return run_share(options.run, interrupt);
  if (name == "status") return run_status(options);
  if (name == "collect") return run_collect(options);
  submit_slurm(options.submit, read_manifest(options.submit.folder, plc_version_string()));
  return 0;
}

}  // namespace plc::tools
