// `pellicle cohort`: a study of many scans, planned, run in shares, and collected.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/cohort/plan.h"
#include "tools/cohort/run.h"
#include "tools/cohort/submit_slurm.h"
#include "tools/command/extract_options.h"
#include "tools/command/interrupt.h"

namespace plc::tools {

struct CohortOptions {
  PlanOptions plan;
  ExtractOptions extract;  // what plan is told of them, only to be checked
  RunOptions run;
  SubmitOptions submit;
  std::string folder;  // of status and collect
  std::string table;   // that collect writes; "": cohort.tsv in the folder
  bool json = false;
};

// Declares plan, run, status, collect and submit under `command`.
void add_cohort_options(CLI::App& command, CohortOptions& options);

// Returns the exit code: 1 where scans have failed, or are not done. Throws Failure.
int run_cohort_command(const CLI::App& command, CohortOptions& options, InterruptGuard& interrupt);

}  // namespace plc::tools
