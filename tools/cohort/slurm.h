// What all that goes to Slurm needs, be it scans of a cohort or blocks of an image.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace plc::tools {

// What a task of a job array asks for.
struct SlurmNeeds {
  std::string job_name;
  std::string array;  // "1-20"; "": sbatch is told
  int cores = 1;
  int64_t mebibytes = 0;
  int64_t minutes = 0;
  std::string log;                   // as sbatch --output takes it
  std::vector<std::string> options;  // further ones of sbatch
};

// The first lines of a script. Its task gets SIGTERM a minute before its time is over, and is
// queued again where its node fails or somebody asks for it.
std::string slurm_head(const SlurmNeeds& needs);

// A command line as a shell takes it.
std::string line_of(const std::vector<std::string>& words);

// How many tasks an array may have: their numbers from 1 to this.
size_t most_array_tasks();

// DIR/submitted/N with the first N of which there is nothing yet: files add their suffixes.
std::string new_submission(const std::string& folder);

// Of the job. Throws Failure.
std::string submit_job(const std::vector<std::string>& words);

// Throws Failure.
void write_text(const std::string& path, const std::string& text);

}  // namespace plc::tools
