// What a run of the demo's head CT tells of its progress, where that is installed.
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

// On one thread, by the processor's time: other programs take nothing of that.
TEST_CASE("what is left of the head CT is told within a factor of two from a fifth on",
          "[progress]") {
  const std::string path = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3";
  if (!std::filesystem::exists(path)) {
    WARN("skipped: " << path << " is not there (invesalius-examples)");
    return;
  }
  const plc::tools::LoadedVolume volume = plc::tools::read_volume(path);
  const samples::Context context = samples::make_context(1);
  for (const int late : {0, 1}) {
    plc_parameters p;
    plc_parameters_defaults(&p);
    p.iso = 226;
    p.late_bubbles = late;
    std::vector<Told> told;
    plc_extras extras = samples::no_extras();
    extras.progress = [](const plc_progress* progress, void* user) {
      static_cast<std::vector<Told>*>(user)->push_back(
          {static_cast<double>(std::clock()) / CLOCKS_PER_SEC, progress->fraction});
      return 0;
    };
    extras.progress_user = &told;
    const double start = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    samples::extract(context.get(), volume.image, p, &extras);
    for (Told& t : told) t.cost -= start;
    CAPTURE(late);
    CHECK(part_off(told) < 0.15);
  }
}
