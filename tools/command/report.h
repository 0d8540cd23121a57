// What `pellicle extract --report` writes.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tools/command/extract_options.h"
#include "tools/file/atomic_file.h"

namespace plc::tools {

struct Timings {
  double read = 0, write = 0, total = 0;  // seconds
};

// The largest memory this process has had.
int64_t peak_rss_bytes();
// As 16 hexadecimal digits.
std::string hash_text(uint64_t hash);

// `options` are those of the run, of which the parameters are not read; measures are of the surface
// in patient space (mm).
nlohmann::ordered_json make_report(plc_context* context, const plc_image& image,
                                   const plc_surface* surface, const plc_measures& measures,
                                   const Timings& timings, const ExtractOptions& options);

// Atomically. Throws Failure.
void write_report(const std::string& path, const nlohmann::ordered_json& report);
// One of several files, which are there once those are committed.
void write_report(const std::string& path, const nlohmann::ordered_json& report,
                  AtomicFiles& files);
// Throws Failure unless a file can be made at `path`.
void check_report_path(const std::string& path);

// A line for each level that the most iterations have ended.
std::vector<std::string> unfinished_levels(plc_context* context, const plc_surface* surface,
                                           int max_iterations);

// A few lines for people.
std::string summary(plc_context* context, const plc_image& image, const plc_surface* surface,
                    const plc_measures& measures, const Timings& timings,
                    const std::string& output);

}  // namespace plc::tools
