// What is left of a cohort as one job array of Slurm.
#pragma once
#include <string>
#include <vector>

#include "tools/cohort/manifest.h"

namespace plc::tools {

struct SubmitOptions {
  std::string folder;
  double minutes = 60;  // of a task
  int cores = 0;        // of a task; 0: one, or more where a scan would not fit in its minutes
  bool retry_failed = false;
  bool dry_run = false;
  std::vector<std::string> slurm;  // further options of sbatch and srun
};

// Runs a pilot scan on a node where none is done yet: it tells seconds and memory. Then writes the
// script and submits it. Everything that is run is printed; with dry_run it is only printed. Throws
// Failure.
void submit_slurm(const SubmitOptions& options, const Manifest& manifest);

}  // namespace plc::tools
