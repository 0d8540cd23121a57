#include "engine/recover/progress_estimate.h"

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

// A whole recovery, as the progress hook sees it.
std::vector<Told> told_of(const Run& run) {
  std::vector<Told> told;
  plc::Mesh mesh;
  std::vector<plc::LevelRecord> records;
  plc::RecoveryHooks hooks;
  hooks.progress = [&](const plc::RecoveryProgress& p) {
    int64_t work = 0;
    for (const plc::LevelRecord& r : records) {
      work += r.operations.moves + 70 * r.operations.transformations();
    }
    CHECK((told.empty() || p.fraction >= told.back().fraction));
    told.push_back({static_cast<double>(work), p.fraction});
    return true;
  };
  const plc::Schedule schedule(1);
  const plc::Status status =
      plc::pyramidal_recover_shape(samples::pyramid_of(run), run.recovery, schedule,
                                   plc::best_simd_target(), hooks, mesh, records);
  REQUIRE(status.ok());
  return told;
}

}  // namespace

TEST_CASE("energies that fall as they do on images are foreseen", "[progress]") {
  for (const double power : {1.0, 1.3, 1.6}) {
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

// Of real images test_progress_ct asks for more; small clean ones rest sooner than those, in no
// time.
TEST_CASE("what is left of a recovery is mostly told within a factor of two from a fifth on",
          "[progress]") {
  const auto shape = samples::empty_volume({48, 48, 48});
  Run ball = samples::make_run("ball", samples::sphere_potential(shape, 0.35), 0.5, 3);
  Run blobs = samples::make_run("blobs", samples::blobs(shape, 12, 3), 0.5, 2);
  for (Run* run : {&ball, &blobs}) run->recovery.model.curvature = 0.1F;
  CHECK(part_off(told_of(ball)) < 0.35);
  blobs.recovery.calm_speed = 1e-9;  // never at rest
  blobs.recovery.max_iterations = 60;
  CHECK(part_off(told_of(blobs)) < 0.45);
}
