// What runs on real images tell of their progress, where those are installed: the demo's head CT
// and templates of brains.
#include <algorithm>
#include <catch2/catch.hpp>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/samples/sample_api.h"
#include "tests/samples/sample_told.h"
#include "tools/volume/volume_io.h"

using samples::part_off;
using samples::Told;

namespace {

struct Case {
  std::string path;
  double iso;
  int late_bubbles;
  plc_mesh_kind mesh;
};

const std::string kHead = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3";
const std::string kTemplates = "/usr/share/mricron/templates/";

double processor_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// On one thread, by the processor's time: other programs take nothing of that.
std::vector<Told> told_of(const Case& run) {
  const plc::tools::LoadedVolume volume = plc::tools::read_volume(run.path);
  const samples::Context context = samples::make_context(1);
  plc_parameters p;
  plc_parameters_defaults(&p);
  p.iso = run.iso;
  p.late_bubbles = run.late_bubbles;
  p.mesh = run.mesh;
  std::vector<Told> told;
  plc_extras extras = samples::no_extras();
  extras.progress = [](const plc_progress* progress, void* user) {
    static_cast<std::vector<Told>*>(user)->push_back({processor_seconds(), progress->fraction});
    return 0;
  };
  extras.progress_user = &told;
  const double start = processor_seconds();
  samples::extract(context.get(), volume.image, p, &extras);
  for (Told& t : told) t.cost -= start;
  return told;
}

}  // namespace

TEST_CASE("what is left of real runs is told within a factor of two, mostly, from a fifth on",
          "[progress]") {
  for (const Case& run : {Case{kHead, 226, 0, PLC_MESH_UNIFORM},
                          {kHead, 226, 1, PLC_MESH_UNIFORM},
                          {kTemplates + "ch2bet.nii.gz", 90, 1, PLC_MESH_UNIFORM},
                          {kTemplates + "ch2bet.nii.gz", 90, 1, PLC_MESH_ADAPTIVE}}) {
    if (!std::filesystem::exists(run.path)) {
      WARN("skipped: " << run.path << " is not there (invesalius-examples, mricron-data)");
      continue;
    }
    CAPTURE(run.path, run.late_bubbles, run.mesh);
    // A machine that becomes slower in the middle of a run says nothing of what was told.
    double least = part_off(told_of(run));
    for (int i = 0; i < 2 && least >= 0.2; ++i) least = std::min(least, part_off(told_of(run)));
    CHECK(least < 0.2);
  }
}
