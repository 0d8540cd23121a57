#include "tools/command/extract_job.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "tools/file/failure.h"
#include "tools/volume/voxels.h"

namespace plc::tools {

namespace {

ExtractJob job_of(const ExtractOptions& options, const plc_parameters& parameters,
                  const IsoChoice& iso, const std::string& name) {
  ExtractJob job{parameters,
                 iso,
                 named(options.output, name),
                 named(options.report, name),
                 named(options.trace, name),
                 false};
  // What the engine would start from, too, but on the full image alone.
  if (!options.attach.empty() && parameters.init == PLC_INIT_AUTO) {
    job.parameters.init = PLC_INIT_BUBBLE;
  }
  return job;
}

int64_t object_voxels(const Voxels& voxels, double iso, bool inside_below) {
  int64_t count = 0;
  voxels.visit([&](const auto* first, const auto* last) {
    count += std::count_if(first, last, [&](auto x) {
      return inside_below ? static_cast<double>(x) <= iso : static_cast<double>(x) >= iso;
    });
  });
  return count;
}

void check_paths(const std::vector<ExtractJob>& jobs) {
  std::set<std::string> seen;
  for (const ExtractJob& job : jobs) {
    for (const std::string& path : {job.output, job.report, job.trace}) {
      if (!path.empty() && !seen.insert(path).second) {
        throw Failure{path + ": would be written twice"};
      }
    }
  }
}

}  // namespace

std::string named(const std::string& path, const std::string& name) {
  if (path.empty() || name.empty()) return path;
  const size_t slash = path.find_last_of('/');
  constexpr std::string_view kSurface = ".surf.gii";  // by custom of neuroimaging
  const size_t dot = path.ends_with(kSurface) ? path.size() - kSurface.size() : path.rfind('.');
  const bool has_suffix = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  const size_t end = has_suffix ? dot : path.size();
  return path.substr(0, end) + "-" + name + path.substr(end);
}

std::vector<ExtractJob> jobs_of(const ExtractOptions& options) {
  std::vector<ExtractJob> jobs;
  if (!options.structures.empty()) {
    for (const Structure& s : options.structures) {
      jobs.push_back(job_of(options, s.parameters, s.iso, s.name));
    }
  } else if (options.isos.size() > 1) {
    for (const IsoChoice& iso : options.isos) {
      const std::string name = iso.is_number() ? text_of(iso.number) : iso.text;
      jobs.push_back(job_of(options, options.parameters, iso, name));
      jobs.back().follows = jobs.size() > 1;
    }
  } else {
    const IsoChoice iso = options.isos.empty() ? IsoChoice{} : options.isos[0];
    jobs.push_back(job_of(options, options.parameters, iso, ""));
  }
  check_paths(jobs);
  return jobs;
}

void resolve(ExtractJob& job, const Voxels& voxels) {
  if (job.iso.text.empty()) return;
  if (!job.iso.is_number() && job.parameters.feature != PLC_FEATURE_NONE) {
    throw Failure{"--iso " + job.iso.text +
                  ": is of the image itself; with --feature gradient-norm a number is needed"};
  }
  job.parameters.iso = resolved(job.iso, voxels);
}

bool nearer(const Voxels& voxels, double from, double to, bool inside_below) {
  const int64_t before = object_voxels(voxels, from, inside_below);
  const int64_t after = object_voxels(voxels, to, inside_below);
  return std::abs(before - after) < after;
}

}  // namespace plc::tools
