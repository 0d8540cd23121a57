#include "engine/motion/sleep.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "engine/base/constants.h"
#include "engine/recover/evolution.h"
#include "engine/resolve/refinement.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_runs.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Mesh;
using plc::Vec3;

constexpr float kSpeed = 0.002F;

// A sphere of 1,026 vertices at rest, with normals.
void fill_sphere(Mesh& mesh) {
  samples::fill_mesh(mesh, samples::sphere(4), 0.08);
  mesh.renumber(plc::morton_order(mesh));
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.normal.set(v, plc::vertex_normal(mesh, v));
}

void rest(Mesh& mesh, plc::Sleep& sleep, int iterations) {
  for (int i = 0; i < iterations; ++i) {
    sleep.choose(false);
    for (const uint32_t block : sleep.awake()) {
      for (uint32_t v = block * plc::kRingLanes; v < (block + 1) * plc::kRingLanes; ++v) {
        mesh.displacement.set(v, {});
      }
    }
    sleep.observe();
  }
  sleep.choose(false);
}

bool is_awake(const plc::Sleep& sleep, uint32_t v) {
  const auto& awake = sleep.awake();
  return std::binary_search(awake.begin(), awake.end(), v / plc::kRingLanes);
}

}  // namespace

TEST_CASE("what has been calm for long falls asleep and loses its speed", "[sleep]") {
  Mesh mesh;
  fill_sphere(mesh);
  mesh.velocity.set(7, {1, 2, 3});
  plc::Sleep sleep(mesh, samples::kSerial, {kSpeed});
  rest(mesh, sleep, plc::kCalmPeriod - 1);
  CHECK_FALSE(sleep.any_asleep());
  CHECK(mesh.velocity.x[7] == 1);
  rest(mesh, sleep, 1);
  CHECK(sleep.awake().empty());
  CHECK(sleep.fallen().size() == mesh.padded() / plc::kRingLanes);
  CHECK(plc::length(mesh.velocity.at(7)) == 0);
  sleep.choose(false);
  CHECK(sleep.fallen().empty());
  sleep.restart();
  sleep.choose(false);
  CHECK(sleep.fallen().size() == mesh.padded() / plc::kRingLanes);
}

TEST_CASE("without a calm speed, or when all are asked for, nothing sleeps", "[sleep]") {
  Mesh mesh;
  fill_sphere(mesh);
  plc::Sleep never(mesh, samples::kSerial, {});
  rest(mesh, never, 20);
  CHECK_FALSE(never.any_asleep());
  plc::Sleep sleep(mesh, samples::kSerial, {kSpeed});
  rest(mesh, sleep, 20);
  CHECK(sleep.awake().empty());
  sleep.choose(true);
  CHECK_FALSE(sleep.any_asleep());
}

TEST_CASE("a vertex that is touched wakes its block", "[sleep]") {
  Mesh mesh;
  fill_sphere(mesh);
  plc::Sleep sleep(mesh, samples::kSerial, {kSpeed});
  rest(mesh, sleep, plc::kCalmPeriod);
  mesh.place(100, mesh.at(100));
  mesh.wake(500);
  sleep.choose(false);
  CHECK(sleep.awake() == plc::Vector<uint32_t>{100 / plc::kRingLanes, 500 / plc::kRingLanes});
  sleep.wake_all();
  sleep.choose(false);
  CHECK_FALSE(sleep.any_asleep());
}

TEST_CASE("what has settled sleeps, however it moved, until it is touched", "[sleep]") {
  Mesh mesh;
  fill_sphere(mesh);
  plc::Sleep sleep(mesh, samples::kSerial, {kSpeed});
  sleep.choose(false);
  REQUIRE_FALSE(sleep.any_asleep());
  sleep.settle();
  mesh.wake(500);
  sleep.choose(false);
  CHECK(sleep.awake() == plc::Vector<uint32_t>{500 / plc::kRingLanes});
}

TEST_CASE("a vertex that moves along its normal wakes its neighbours, one that slides does not",
          "[sleep]") {
  Mesh mesh;
  fill_sphere(mesh);
  plc::Sleep sleep(mesh, samples::kSerial, {kSpeed});
  const auto delta = static_cast<float>(mesh.delta);
  for (const bool slides : {false, true}) {
    sleep.wake_all();
    rest(mesh, sleep, plc::kCalmPeriod);
    const uint32_t v = 200;
    const Vec3 n = mesh.normal.at(v);
    const Vec3 along = slides ? plc::cross(n, {0.6F, 0, 0.8F}) : n;
    // A fifth of what wakes others, five times and once for the steps that are left.
    for (int i = 0; i < 7; ++i) {
      mesh.wake(v);
      sleep.choose(false);
      REQUIRE(is_awake(sleep, v));
      for (const uint32_t block : sleep.awake()) {
        for (uint32_t u = block * plc::kRingLanes; u < (block + 1) * plc::kRingLanes; ++u) {
          mesh.displacement.set(u, {});
        }
      }
      mesh.displacement.set(v, along * (plc::kWakeMove * delta / 5 / plc::length(along)));
      sleep.observe();
    }
    for (uint32_t k = 0; k < mesh.valence(v); ++k) {
      CHECK((sleep.calm()[mesh.neighbor(v, k)] < plc::kCalmPeriod) == !slides);
    }
  }
}

TEST_CASE("the rim is what sleeps next to what is awake", "[sleep]") {
  Mesh mesh;
  fill_sphere(mesh);
  plc::Sleep sleep(mesh, samples::kSerial, {kSpeed});
  sleep.choose(false);
  CHECK(sleep.awake_and_rim() == sleep.awake());
  rest(mesh, sleep, plc::kCalmPeriod);
  mesh.wake(100);
  mesh.wake(800);
  sleep.choose(false);
  std::set<uint32_t> expected(sleep.awake().begin(), sleep.awake().end());
  for (const uint32_t block : sleep.awake()) {
    for (uint32_t v = block * plc::kRingLanes; v < (block + 1) * plc::kRingLanes; ++v) {
      for (const uint32_t w : mesh.ring(v)) expected.insert(w / plc::kRingLanes);
    }
  }
  CHECK(expected.size() > 4);
  const auto& found = sleep.awake_and_rim();
  CHECK(plc::Vector<uint32_t>(expected.begin(), expected.end()) == found);
}

TEST_CASE("vertices that were created since are not taken for sleepers", "[sleep]") {
  Mesh mesh;
  fill_sphere(mesh);
  plc::Sleep sleep(mesh, samples::kSerial, {});
  sleep.choose(false);
  CHECK_FALSE(sleep.any_asleep());
  mesh.reserve(mesh.slots() + 64);
  for (int i = 0; i < 40; ++i) mesh.create({2, 2, 2}, {});
  CHECK_FALSE(sleep.any_asleep());
}

TEST_CASE("who is awake does not depend on the executor", "[sleep]") {
  Mesh one, other;
  plc::Vector<uint32_t> awake;
  for (Mesh* mesh : {&one, &other}) {
    samples::fill_mesh(*mesh, samples::sphere(6), 0.02);
    for (uint32_t v = 0; v < mesh->slots(); ++v) {
      mesh->normal.set(v, plc::vertex_normal(*mesh, v));
    }
    const fixtures::ThreadExecutor threads(3);
    const plc::Executor& executor =
        mesh == &one ? static_cast<const plc::Executor&>(samples::kSerial) : threads;
    plc::Sleep sleep(*mesh, executor, {kSpeed});
    samples::Random random(3);
    for (int i = 0; i < 20; ++i) {
      sleep.choose(false);
      for (uint32_t v = 0; v < mesh->slots(); ++v) {
        const auto far = static_cast<float>(random.uniform(0, 1) < 0.002 ? 0.0005 : 0);
        mesh->displacement.set(v, {far, far, far});
      }
      sleep.observe();
    }
    sleep.choose(false);
    CHECK(sleep.any_asleep());
    CHECK(sleep.awake().size() > 5);
    if (mesh == &one) {
      awake = sleep.awake();
    } else {
      CHECK(sleep.awake() == awake);
    }
  }
}

TEST_CASE("a run with sleepers ends where one without ends, within what epsilon leaves open",
          "[sleep]") {
  const samples::Volume volume = samples::blobs(samples::empty_volume({56, 56, 56}), 14, 5);
  std::vector<double> volumes;
  plc::Vector<uint32_t> vertices;
  for (const bool sleeping : {false, true}) {
    samples::Run run = samples::make_run("blobs", volume, 0.4, 1);
    run.recovery.sleeping = sleeping;
    run.recovery.max_iterations = 400;
    const plc::Schedule schedule(1);
    const plc::Pyramid pyramid = samples::pyramid_of(run, schedule);
    Mesh mesh;
    std::vector<plc::LevelRecord> records;
    REQUIRE(plc::pyramidal_recover_shape(pyramid, run.recovery, schedule, {}, mesh, records).ok());
    for (const auto& record : records) CHECK(record.converged);
    CHECK(samples::meeting_count(mesh) == 0);
    volumes.push_back(samples::volume(mesh));
    vertices.push_back(mesh.vertex_count());
  }
  CHECK(volumes[0] != volumes[1]);  // some slept
  CHECK(volumes[1] == Approx(volumes[0]).epsilon(0.002));
  CHECK(vertices[1] == Approx(vertices[0]).epsilon(0.02));
}
