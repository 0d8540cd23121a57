#include "tools/cohort/slurm.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <system_error>

#include "tools/cohort/child.h"
#include "tools/file/atomic_file.h"
#include "tools/file/failure.h"

namespace plc::tools {
namespace {

namespace fs = std::filesystem;

constexpr size_t kDefaultArraySize = 1001;  // Slurm's own

}  // namespace

std::string slurm_head(const SlurmNeeds& needs) {
  std::ostringstream text;
  text << "#!/bin/bash\n"
       << "#SBATCH --job-name=" << needs.job_name << "\n";
  if (!needs.array.empty()) text << "#SBATCH --array=" << needs.array << "\n";
  text << "#SBATCH --ntasks=1\n"
       << "#SBATCH --cpus-per-task=" << needs.cores << "\n"
       << "#SBATCH --mem=" << needs.mebibytes << "M\n"
       << "#SBATCH --time=" << needs.minutes << "\n"
       << "#SBATCH --signal=B:TERM@60\n"
       << "#SBATCH --requeue\n"
       << "#SBATCH --open-mode=append\n"
       << "#SBATCH --output=" << quoted(needs.log) << "\n";
  for (const std::string& option : needs.options) text << "#SBATCH " << option << "\n";
  return text.str();
}

std::string line_of(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) {
    if (!line.empty()) line += ' ';
    line += quoted(word);
  }
  return line;
}

size_t most_array_tasks() {
  std::string config;
  size_t size = kDefaultArraySize;  // the largest number, and one
  if (run_program({"scontrol", "show", "config"}, config) == 0) {
    std::istringstream lines(config);
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with("MaxArraySize")) continue;
      const size_t sign = line.find('=');
      if (sign != std::string::npos) size = std::max(2UL, std::stoul(line.substr(sign + 1)));
    }
  }
  return size - 1;
}

std::string new_submission(const std::string& folder) {
  for (int number = 1;; ++number) {
    std::string path = folder + "/submitted/" + std::to_string(number);
    if (!fs::exists(path + ".txt") && !fs::exists(path + ".sh")) return path;
  }
}

std::string submit_job(const std::vector<std::string>& words) {
  std::string job;
  const int code = run_program(words, job);
  if (code != 0) {
    throw Failure{words[0] + ": ends with exit code " + std::to_string(code) +
                  "; nothing has been submitted"};
  }
  return job.substr(0, job.find_first_of(";\n"));
}

void write_text(const std::string& path, const std::string& text) {
  AtomicFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace plc::tools
