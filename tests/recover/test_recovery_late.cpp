// Recoveries: late bubbles, and what the user says at the end of a level.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/samples/sample_recovery.h"

namespace {

using plc::LevelRecord;
using plc::LevelVerdict;
using samples::check_valid;
using samples::recover;
using samples::Recovered;
using samples::Run;
using samples::sphere_volume;

constexpr double kMain = 11, kHole = 4.5, kSide = 3.2;

// A ball with a cavity that the start does not see, and a ball apart from it that the coarse level
// does not show at its iso-value.
Run hidden_run(int levels) {
  const auto volume =
      samples::sampled(samples::empty_volume({44, 28, 28}), [](const samples::Point& p) {
        const double far = samples::norm(p[0] - 8, p[1], p[2]);
        const double side = samples::norm(p[0] + 17, p[1], p[2]);
        const auto ramp = [](double depth) { return std::clamp(0.5 + 0.25 * depth, 0.0, 1.0); };
        return std::max(std::min(ramp(kMain - far), ramp(far - kHole)), ramp(kSide - side));
      });
  Run run = samples::make_run("hidden", volume, 0.5, levels);
  run.recovery.model.curvature = 0.1F;
  // The bubble around the coarse object leaves out the small ball.
  if (levels > 0) run.recovery.isos.back() = 0.6;
  return run;
}

Run ball_run(int levels) {
  Run run = samples::make_run(
      "ball", samples::sphere_potential(samples::empty_volume({28, 28, 28}), 0.35), 0.5, levels);
  run.recovery.model.curvature = 0.1F;
  return run;
}

plc::RecoveryHooks answering(const std::function<LevelVerdict(const LevelRecord&)>& level) {
  plc::RecoveryHooks hooks;
  hooks.level = level;
  return hooks;
}

}  // namespace

TEST_CASE("late bubbles find the part and the cavity that the surface has passed by",
          "[recovery]") {
  for (const int levels : {0, 2}) {
    Run run = hidden_run(levels);
    if (levels == 0) {
      run.recovery.start.init = plc::Init::kSeeds;
      run.recovery.start.seeds = {{{29.5, 13.5, 13.5}, {12.5, 12.5, 12.5}}};
    }
    const Recovered with = recover(run);
    REQUIRE(with.status.ok());
    check_valid(with.mesh);
    CHECK(samples::component_count(with.mesh) == 3);
    CHECK(samples::euler(with.mesh) == 6);
    const double whole = sphere_volume(kMain) - sphere_volume(kHole) + sphere_volume(kSide);
    CHECK(samples::volume(with.mesh) == Approx(whole).epsilon(0.05));
    int64_t bubbles = 0, cavities = 0;
    double volume = 0;
    for (const LevelRecord& r : with.records) {
      bubbles += r.late.bubbles;
      cavities += r.late.cavities;
      volume += r.late.volume;
    }
    CHECK(bubbles == 1);
    CHECK(cavities == 1);
    CHECK(volume == Approx(sphere_volume(kHole) + sphere_volume(kSide)).epsilon(0.3));

    run.recovery.late_bubbles = false;
    const Recovered without = recover(run);
    REQUIRE(without.status.ok());
    CHECK(samples::component_count(without.mesh) == 1);
    CHECK(samples::volume(without.mesh) == Approx(sphere_volume(kMain)).epsilon(0.05));
    for (const LevelRecord& r : without.records) CHECK(r.late.bubbles + r.late.cavities == 0);
  }
}

TEST_CASE("what an adaptive mesh has missed is searched for before all of it is woken and checked",
          "[recovery]") {
  for (const bool adaptive : {false, true}) {
    Run run = hidden_run(0);
    run.recovery.start.init = plc::Init::kSeeds;
    run.recovery.start.seeds = {{{29.5, 13.5, 13.5}, {12.5, 12.5, 12.5}}};
    if (adaptive) run.recovery.sizes.emplace();
    int searches = 0, checks = 0;
    plc::RecoveryHooks hooks;
    hooks.pass = [&](const std::string& pass, uint32_t, const plc::Evolution&) {
      searches += pass == "late bubbles" ? 1 : 0;
      checks += pass == "check of all" ? 1 : 0;
    };
    const Recovered r = recover(run, hooks);
    REQUIRE(r.status.ok());
    CHECK(r.records[0].converged);
    CHECK(r.records[0].late.bubbles == 1);
    CHECK(searches == 2);
    // In adaptive meshes at the start, too.
    CHECK(checks == 2);
  }
}

TEST_CASE("all rounds after late bubbles together take no more iterations than the one before them",
          "[recovery]") {
  // A sphere that springs draw together over a large ball: one ball is far outside, and found
  // first; a small one is passed by the sphere in the first round after that, and found then.
  const auto volume =
      samples::sampled(samples::empty_volume({60, 40, 40}), [](const samples::Point& p) {
        double most = 0;
        for (const auto& [x, radius] : {std::pair{-10.0, 5.0}, {-0.5, 1.8}, {24.0, 3.5}}) {
          const double depth = radius - samples::norm(p[0] - x, p[1], p[2]);
          most = std::max(most, std::clamp(0.5 + 0.5 * depth, 0.0, 1.0));
        }
        return most;
      });
  Run run = samples::make_run("two late balls", volume, 0.5, 0);
  run.recovery.start.init = plc::Init::kSeeds;
  run.recovery.start.seeds = {{{19.5, 19.5, 19.5}, {13.5, 13.5, 13.5}}};
  run.recovery.model.spring = 1;
  run.recovery.model.rest_length = plc::RestLength::kZero;
  run.recovery.epsilon = 1;  // any surface is searched
  run.recovery.max_iterations = 11;
  const Recovered r = recover(run);
  REQUIRE(r.status.ok());
  CHECK(r.records[0].late.bubbles >= 1);
  CHECK(r.records[0].iterations == 22);
}

TEST_CASE("the volume of late bubbles is in cubic millimetres, whatever the space", "[recovery]") {
  for (const plc::Anisotropy method :
       {plc::Anisotropy::kPhysical, plc::Anisotropy::kVoxel, plc::Anisotropy::kMetric}) {
    Run run = hidden_run(0);
    run.volume.spacing = {2, 2, 3};
    run.recovery.scale.anisotropy = method;
    run.recovery.start.init = plc::Init::kSeeds;
    run.recovery.start.seeds = {{{29.5, 13.5, 13.5}, {12.5, 12.5, 12.5}}};
    const Recovered r = recover(run);
    REQUIRE(r.status.ok());
    REQUIRE(r.records.size() == 1);
    CHECK(r.records[0].late.bubbles == 1);
    CHECK(r.records[0].late.cavities == 1);
    CHECK(r.records[0].late.volume ==
          Approx(12 * (sphere_volume(kHole) + sphere_volume(kSide))).epsilon(0.2));
  }
}

TEST_CASE("an object that one bubble finds has no late ones", "[recovery]") {
  const Recovered r = recover(ball_run(2));
  REQUIRE(r.status.ok());
  for (const LevelRecord& record : r.records)
    CHECK(record.late.bubbles + record.late.cavities == 0);
}

TEST_CASE("the level hook sees every level that holds a surface, coarse to fine", "[recovery]") {
  std::vector<LevelRecord> seen;
  const Recovered r = recover(ball_run(2), answering([&](const LevelRecord& record) {
                                seen.push_back(record);
                                return LevelVerdict::kAccept;
                              }));
  REQUIRE(r.status.ok());
  REQUIRE(seen.size() == 3);
  for (size_t i = 0; i < 3; ++i) {
    CHECK(seen[i].level == 2 - static_cast<int>(i));
    CHECK(seen[i].iterations == r.records[i].iterations);
    CHECK(seen[i].vertices == r.records[i].vertices);
    CHECK(seen[i].converged);
  }
}

TEST_CASE("a level that the user asks more of runs on, up to the cap each time", "[recovery]") {
  Run run = ball_run(1);
  run.recovery.max_iterations = 7;
  std::vector<int64_t> iterations;
  const Recovered r =
      recover(run, answering([&](const LevelRecord& record) {
                iterations.push_back(record.iterations);
                return iterations.size() < 4 ? LevelVerdict::kMore : LevelVerdict::kAccept;
              }));
  REQUIRE(r.status.ok());
  CHECK(iterations == std::vector<int64_t>{7, 14, 21, 28, 7});
  CHECK(r.records[0].iterations == 28);
  CHECK(r.records[1].iterations == 7);
  check_valid(r.mesh);
  // One that had converged needs the least a level runs for again.
  int asked = 0;
  const Recovered again =
      recover(ball_run(0), answering([&](const LevelRecord&) {
                return ++asked < 3 ? LevelVerdict::kMore : LevelVerdict::kAccept;
              }));
  REQUIRE(again.status.ok());
  CHECK(again.records[0].iterations == recover(ball_run(0)).records[0].iterations + 40);
}

TEST_CASE("a user who says stop gets that level's surface, in that level's space", "[recovery]") {
  for (const plc::Anisotropy method : {plc::Anisotropy::kVoxel, plc::Anisotropy::kMetric}) {
    for (const int last : {2, 1}) {
      Run run = ball_run(2);
      run.volume.spacing = {1, 1, 1.5};
      run.recovery.scale.anisotropy = method;
      std::vector<plc::Vec3> seen;
      Recovered r;
      const plc::Schedule schedule(1);
      const plc::Pyramid pyramid = samples::pyramid_of(run);
      r.status = plc::pyramidal_recover_shape(
          pyramid, run.recovery, schedule, answering([&](const LevelRecord& record) {
            // At the end of the level: without gaps, and what the caller gets if this is the last.
            CHECK(r.mesh.slots() == r.mesh.vertex_count());
            CHECK(r.mesh.vertex_count() == record.vertices);
            seen.clear();
            for (uint32_t v = 0; v < r.mesh.slots(); ++v) seen.push_back(r.mesh.at(v));
            return record.level == last ? LevelVerdict::kStop : LevelVerdict::kAccept;
          }),
          r.mesh, r.records);
      REQUIRE(r.status.ok());
      CHECK(r.records.size() == static_cast<size_t>(3 - last));
      CHECK(r.records.back().level == last);
      check_valid(r.mesh);
      REQUIRE(seen.size() == r.mesh.slots());
      for (uint32_t v = 0; v < r.mesh.slots(); ++v) {
        CHECK(plc::length(seen[v] - r.mesh.at(v)) == 0);
      }
      const plc::MeshSpace space = plc::mesh_space(pyramid, last, method);
      const double voxel = space.step[0] * space.step[1] * space.step[2];
      // Coarse images show the ball smaller.
      CHECK(samples::volume(r.mesh) / voxel ==
            Approx(0.87 * sphere_volume(0.35 * 28)).epsilon(0.2));
    }
  }
}

TEST_CASE("a level is calm only when its fastest vertex is, where that is asked for",
          "[recovery]") {
  Run run = ball_run(0);
  run.recovery.epsilon = 1e-3;
  const Recovered energetic = recover(run);
  REQUIRE(energetic.status.ok());
  CHECK(energetic.records[0].converged);
  CHECK(energetic.records[0].speed > 1e-3);
  run.recovery.calm_speed = 1e-3;
  const Recovered calm = recover(run);
  REQUIRE(calm.status.ok());
  CHECK(calm.records[0].converged);
  CHECK(calm.records[0].speed < 1e-3);
  CHECK(calm.records[0].iterations > energetic.records[0].iterations);
}
