// One run of a case: makes it in its way, listens to its callbacks, and looks at what comes out.
#pragma once
#include <string>

#include "tests/campaign/campaign_host.h"
#include "tests/campaign/campaign_run.h"
#include "tests/samples/sample_handles.h"

namespace campaign {

using samples::Context;
using samples::Surface;
using Volume = samples::VolumeHandle;
using Pyramid = samples::PyramidHandle;
using Run = samples::RunHandle;

// Of all threads of the process: what else the machine does is no part of it.
double processor_seconds();

samples::Soup soup_of(plc_context* context, const plc_surface* surface, plc_space space);
// With the coordinates that the mesh evolves in, which no change of space has rounded.
samples::Soup exact_soup(const plc_surface* surface);

// What is wrong with a mesh, kNone where nothing is; checker: any context.
Finding judge(plc_context* checker, const samples::Soup& soup, std::string& what);

class Watch {
 public:
  Watch(const Case& c, const Way& way, bool exact)
      : case_(c), way_(way), exact_(exact), checker_(one_thread()) {}

  // memory_limit: bytes, 0: none.
  RunRecord run(int64_t memory_limit, samples::Soup* mesh);
  Finding finding() const { return finding_; }
  const std::string& what() const { return what_; }

 private:
  static Context one_thread();
  Context lent_context(int64_t memory_limit);

  void fail(Finding finding, const std::string& what) {
    if (finding_ != Finding::kNone) return;
    finding_ = finding;
    what_ = what;
  }

  plc_extras listening();
  Surface extract(plc_context* context, const plc_image& image);
  Surface in_steps(plc_context* context, const plc_image& image);
  bool advance(plc_context*& context, const Pyramid& pyramid, Run& run, bool& done);
  bool restore(plc_context*& context, const Pyramid& pyramid, Run& run);
  void look(plc_context* context, const plc_run* run);
  bool succeeds(plc_context* context, plc_status status);

  int progress(const plc_progress& p);
  plc_verdict level(const plc_level_report& report, const plc_surface* surface);
  int force(const plc_force_points& points, float* forces) const;
  void check(const samples::Soup& soup, const std::string& where, bool rounded);
  void check_report(const plc_level_report& report);
  void check_result(const plc_surface* surface);
  void check_status();
  bool cancels() const;
  int iterations() const { return static_cast<int>(record_.iterations.size()); }

  const Case& case_;
  const Way& way_;
  bool exact_;  // whether meshes are checked
  Context checker_;
  HostMemory memory_;  // outlives what is made with it
  Context other_;      // where a saved run goes on
  RunRecord record_;
  int64_t work_ = 0;
  bool more_given_ = false;
  int looked_at_ = 0;  // iteration
  Finding finding_ = Finding::kNone;
  std::string what_;
};

}  // namespace campaign
