#include "engine/recover/progress_estimate.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/samples/sample_runs.h"
#include "tests/samples/sample_told.h"

namespace {

using plc::OperationCounts;
using plc::ProgressEstimate;
using samples::part_off;
using samples::Run;
using samples::Told;

// Levels of so many iterations, energies in epsilon by iteration, three times the vertices on each.
std::vector<Told> levels_of(int levels, int iterations, int most,
                            const std::function<double(int)>& energy) {
  ProgressEstimate estimate;
  std::vector<Told> told;
  double before = 0, vertices = 1000;
  for (int level = levels; level >= 0; --level, vertices *= 3) {
    estimate.start_level();
    estimate.start_round();
    OperationCounts counts;
    for (int i = 1; i <= iterations; ++i) {
      counts.moves += static_cast<int64_t>(vertices);
      const double done = estimate.add(counts, energy(i),
                                       {most - i, vertices, level, false, false, i == iterations});
      told.push_back({before + static_cast<double>(counts.moves), done});
    }
    before = told.back().cost;
  }
  return told;
}

// The fractions of a whole recovery, as the progress hook sees them.
std::vector<double> told_of(const Run& run) {
  std::vector<double> told;
  plc::Mesh mesh;
  std::vector<plc::LevelRecord> records;
  plc::RecoveryHooks hooks;
  hooks.progress = [&](const plc::RecoveryProgress& p) {
    told.push_back(p.fraction);
    return true;
  };
  const plc::Schedule schedule(1);
  const plc::Status status = plc::pyramidal_recover_shape(samples::pyramid_of(run), run.recovery,
                                                          schedule, hooks, mesh, records);
  REQUIRE(status.ok());
  return told;
}

}  // namespace

TEST_CASE("energies that fall as they do on images are foreseen", "[progress]") {
  for (const double power : {0.8, 1.0, 1.3}) {
    const auto told = levels_of(3, 400, 100000, [&](int i) { return std::pow(400.0 / i, power); });
    CAPTURE(power);
    CHECK(part_off(told) < 0.12);
  }
}

TEST_CASE("a round that does not come to rest is foreseen to take what it may", "[progress]") {
  // Whether its energy falls below epsilon the next moment nobody knows.
  CHECK(part_off(levels_of(3, 500, 500, [](int) { return 8.0; })) < 0.15);
  CHECK(part_off(levels_of(3, 500, 500, [](int i) { return i % 2 == 0 ? 20.0 : 2.0; })) < 0.15);
}

TEST_CASE("all is done when the last level is calm, or may not go on", "[progress]") {
  CHECK(levels_of(1, 50, 500, [](int i) { return 100.0 / i; }).back().fraction == 1);
  CHECK(levels_of(1, 50, 50, [](int) { return 100.0; }).back().fraction == 1);
}

// How right it is on real images test_progress_volumes asks; small clean ones rest in no time.
TEST_CASE("progress does not fall", "[progress]") {
  const auto shape = samples::empty_volume({48, 48, 48});
  Run ball = samples::make_run("ball", samples::sphere_potential(shape, 0.35), 0.5, 3);
  Run blobs = samples::make_run("blobs", samples::blobs(shape, 12, 3), 0.5, 2);
  blobs.recovery.calm_speed = 1e-9;  // never at rest
  blobs.recovery.max_iterations = 60;
  for (Run* run : {&ball, &blobs}) {
    run->recovery.model.curvature = 0.1F;
    const std::vector<double> told = told_of(*run);
    CHECK(told.size() > 50);
    CHECK(told.front() < 0.5);
    CHECK(std::is_sorted(told.begin(), told.end()));
  }
}
