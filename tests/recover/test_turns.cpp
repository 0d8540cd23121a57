// What never rests is brought to rest: mesh/turns.h, from the counting to whole recoveries.
#include "engine/mesh/turns.h"

#include <catch2/catch.hpp>

#include "engine/motion/sleep.h"
#include "engine/recover/frozen_sites.h"
#include "tests/samples/sample_recovery.h"
#include "tests/samples/sample_sizing.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::LevelRecord;
using plc::Mesh;
using samples::Recovered;
using samples::Run;

// Noise that is finer than the mesh, on every level.
Run noisy_run(uint64_t seed) {
  samples::Volume volume = samples::noise(samples::empty_volume({30, 26, 28}), 3, seed);
  samples::add_noise(volume, 0.1, seed + 1);
  return samples::make_run("noise", std::move(volume), 0.5, 1);
}

}  // namespace

TEST_CASE("a vertex turns where its movement along the normal changes sides, if it is fast enough",
          "[turns]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), 0.2);
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.normal.set(v, plc::vertex_normal(mesh, v));
  constexpr float kTurn = 0.01F;
  plc::Sleep sleep(mesh, samples::kSerial, {0, kTurn});
  const auto delta = static_cast<float>(mesh.delta);
  const auto move = [&](float outwards) {
    sleep.choose(false);
    for (uint32_t v = 0; v < mesh.slots(); ++v) {
      mesh.displacement.set(v, mesh.normal.at(v) * (outwards * delta));
    }
    sleep.observe();
    return plc::turns_of(mesh.turns[40]);
  };
  CHECK(move(0.02F) == 0);
  CHECK(move(0.02F) == 0);
  CHECK(move(-0.009F) == 0);  // too slow, and forgotten
  CHECK(move(0.02F) == 0);
  CHECK(move(-0.02F) == 1);
  CHECK(move(0.009F) == 1);
  CHECK(move(0.011F) == 2);
  float side = -0.02F;
  for (uint32_t turns = 3; turns < plc::kFrozenTurns; ++turns, side = -side) {
    REQUIRE(move(side) == turns);
    REQUIRE_FALSE(plc::frozen(mesh.turns[40]));
  }
  for (int i = 0; i < 50; ++i, side = -side) CHECK(move(side) == plc::kFrozenTurns);
  CHECK(plc::frozen(mesh.turns[40]));
}

TEST_CASE("what goes round in circles is neither cut nor, frozen, joined; all else goes on",
          "[turns]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(2), 1);
  const auto asked = [&](plc::Operation operation, uint32_t turns) {
    mesh.turns[3] = plc::with_turns(0x80, turns);
    return plc::goes_in_circles(mesh, {operation, 1, {1, 2, 3, 4}}) ||
           plc::goes_in_circles(mesh, {operation, 1, {3, 2, 1, 4}});
  };
  using plc::Operation;
  CHECK_FALSE(asked(Operation::kAnnular, plc::kFreeTurns - 1));
  CHECK(asked(Operation::kAnnular, plc::kFreeTurns));
  CHECK_FALSE(asked(Operation::kAxial, plc::kFrozenTurns - 1));
  CHECK(asked(Operation::kAxial, plc::kFrozenTurns));
  for (const Operation o : {Operation::kCreation, Operation::kDeletion, Operation::kInversion}) {
    CHECK_FALSE(asked(o, plc::kFrozenTurns));
  }
  const samples::FullImage image(true);
  mesh.sizing = &image.sizing;  // that what is cut is not there is known
  CHECK_FALSE(asked(Operation::kAnnular, plc::kFrozenTurns));
  CHECK(asked(Operation::kAxial, plc::kFrozenTurns));
  plc::freeze(mesh, plc::cut_along({{1, 2, 5}}, 1));
  for (const uint32_t v : {1U, 2U, 5U}) CHECK(plc::frozen(mesh.turns[v]));
  CHECK_FALSE(plc::frozen(mesh.turns[4]));
  plc::freeze(mesh, plc::cut_along({{6, 7, 8, 9}, 4}, 1));
  for (const uint32_t v : {6U, 7U, 8U, 9U}) CHECK(plc::frozen(mesh.turns[v]));
}

TEST_CASE("frozen vertices that edges connect are one site, the largest first", "[turns]") {
  Mesh mesh;
  samples::fill_mesh(mesh, samples::sphere(3), 0.2);
  CHECK(plc::frozen_sites(mesh).empty());
  const uint32_t one = 5;
  uint32_t far = 0;
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    if (plc::squared_distance(mesh.at(v), mesh.at(one)) >
        plc::squared_distance(mesh.at(far), mesh.at(one))) {
      far = v;
    }
  }
  mesh.turns[one] = plc::kFrozenTurns;
  mesh.turns[far] = plc::kFrozenTurns;
  for (uint32_t k = 0; k < mesh.valence(far); ++k) {
    mesh.turns[mesh.neighbor(far, k)] = plc::kFrozenTurns;
  }
  const auto sites = plc::frozen_sites(mesh);
  REQUIRE(sites.size() == 2);
  CHECK(sites[0].vertices == 1 + static_cast<int64_t>(mesh.valence(far)));
  CHECK(plc::length(sites[0].place - mesh.at(far)) < 0.3F);
  CHECK(sites[1].vertices == 1);
  CHECK(plc::length(sites[1].place - mesh.at(one)) == 0);
}

TEST_CASE("every level of a noisy image comes to rest, far from the most iterations", "[turns]") {
  int64_t frozen = 0;
  for (const uint64_t seed : {1U, 2U, 3U}) {
    Run run = noisy_run(seed);
    run.recovery.max_iterations = 2000;
    const Recovered r = samples::recover(run);
    REQUIRE(r.status.ok());
    for (const LevelRecord& level : r.records) {
      CAPTURE(seed, level.level, level.energy);
      CHECK(level.converged);
      CHECK(level.iterations < 1000);
      frozen += level.frozen_vertices;
      CHECK(level.frozen_sites <= level.frozen_vertices);
    }
    samples::check_valid(r.mesh);
    const auto sites = plc::frozen_sites(r.mesh);
    CHECK(static_cast<int64_t>(sites.size()) == r.records.back().frozen_sites);
  }
  CHECK(frozen > 0);
}

TEST_CASE("a surface has arrived when it goes to both sides, or had the time to cross the image",
          "[turns]") {
  plc::Travel travel;
  CHECK_FALSE(travel.going());
  travel.start(1000);
  int iterations = 0;
  for (; iterations < 50; ++iterations) travel.observe(-90, 100);
  CHECK(travel.going());
  for (; travel.going(); ++iterations) travel.observe(iterations % 2 == 0 ? 30 : -30, 100);
  CHECK(iterations > 60);
  CHECK(iterations < 100);
  travel.start(30);
  for (iterations = 0; travel.going(); ++iterations) travel.observe(100, 100);
  CHECK(iterations == 30);
}

TEST_CASE("a front that sweeps through noise leaves nothing behind", "[turns]") {
  samples::Volume volume = samples::sampled(
      samples::empty_volume({56, 56, 56}),
      [](const samples::Point& p) { return samples::norm(p[0], p[1], p[2]) < 10 ? 1.0 : 0.0; });
  samples::add_noise(volume, 0.9, 3);
  const Recovered r = samples::recover(samples::make_run("ball", std::move(volume), 0.5, 0));
  REQUIRE(r.status.ok());
  // Counted from the start, turns freeze 275 vertices outside of the ball, and 1,039 are left.
  CHECK(r.records.back().converged);
  CHECK(r.records.back().frozen_vertices < 20);
  CHECK(r.mesh.vertex_count() < 850);
}

TEST_CASE("nothing freezes where nothing goes round in circles", "[turns]") {
  const Recovered r = samples::recover(samples::make_run(
      "ball", samples::sphere_potential(samples::empty_volume({40, 40, 40}), 0.35), 0.5, 1));
  REQUIRE(r.status.ok());
  for (const LevelRecord& level : r.records) {
    CHECK(level.converged);
    CHECK(level.frozen_vertices == 0);
  }
}
