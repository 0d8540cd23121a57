#include "engine/recover/recovery.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "engine/resolve/refinement.h"
#include "tests/samples/sample_runs.h"

namespace {

using plc::ErrorCode;
using plc::LevelRecord;
using plc::Mesh;
using plc::RecoveryProgress;
using samples::Run;

struct Recovered {
  plc::Status status;
  Mesh mesh;
  std::vector<LevelRecord> records;
  std::vector<RecoveryProgress> progress;
};

// Cancelled after `most` iterations.
Recovered recover(const Run& run, size_t most = 1000000) {
  Recovered r;
  const plc::Schedule schedule(1);
  const plc::Pyramid pyramid = samples::pyramid_of(run);
  REQUIRE(!pyramid.levels.empty());
  const auto watch = [&](const RecoveryProgress& p) {
    r.progress.push_back(p);
    return r.progress.size() < most;
  };
  r.status =
      plc::pyramidal_recover_shape(pyramid, run.recovery, schedule, {watch, {}}, r.mesh, r.records);
  return r;
}

Run ball_run(int levels, double reduction = plc::kRefinement) {
  Run run = samples::make_run(
      "ball", samples::sphere_potential(samples::empty_volume({28, 28, 28}), 0.35), 0.5, levels);
  run.pyramid.reduction = reduction;
  run.recovery.model.curvature = 0.1F;
  return run;
}
constexpr double kRadius = 0.35 * 28;

double sphere_volume(double r) {
  return 4.0 / 3 * 3.14159265358979 * r * r * r;
}

}  // namespace

TEST_CASE("a ball is recovered as one sphere of its volume on every level", "[recovery]") {
  for (const int levels : {0, 1, 2, 3}) {
    const Recovered r = recover(ball_run(levels));
    REQUIRE(r.status.ok());
    CHECK(plc::broken_invariant(r.mesh) == "");
    CHECK(samples::meeting_count(r.mesh) == 0);
    CHECK(samples::euler(r.mesh) == 2);
    CHECK(samples::component_count(r.mesh) == 1);
    CHECK(samples::volume(r.mesh) == Approx(sphere_volume(kRadius)).epsilon(0.03));
    REQUIRE(r.records.size() == static_cast<size_t>(levels) + 1);
    for (size_t i = 0; i < r.records.size(); ++i) {
      CHECK(r.records[i].level == levels - static_cast<int>(i));
      CHECK(r.records[i].converged);
      CHECK(r.records[i].iterations >= plc::kMinIterations);
      CHECK(r.records[i].energy < 5e-6);
      CHECK(r.records[i].vertices > 0);
      CHECK(r.records[i].seconds.total > 0);
    }
    CHECK(r.records.back().vertices == r.mesh.vertex_count());
  }
}

TEST_CASE("the mesh's density fits every level's image: (14), figure 12", "[recovery]") {
  struct Factor {
    double reduction;
    int refinements;  // per level: those that come nearest to the factor
  };
  for (const Factor& f : {Factor{1.25, 0}, Factor{plc::kRefinement, 1}, Factor{2, 1}}) {
    Run run = ball_run(3, f.reduction);
    run.recovery.isos = {0.5, 0.5, 0.4, 0.3};  // the ball shows on all
    const Recovered r = recover(run);
    REQUIRE(r.status.ok());
    for (const LevelRecord& record : r.records) {
      CHECK(record.vertices > 0);
      const double unit = std::pow(f.reduction, record.level);  // U_h in mesh units
      CHECK(record.delta == Approx(unit / plc::kUnitPerDelta));
      CHECK(unit / record.delta >= 1);
      CHECK(unit / record.delta < plc::kMaxEdge / plc::kRefinement);
      CHECK(record.operations.refinement == (record.level == 3 ? 0 : f.refinements));
    }
    // (1) and (2) at the end.
    const double delta = r.mesh.delta;
    CHECK(delta == Approx(1 / plc::kUnitPerDelta));
    samples::for_each_edge(r.mesh, [&](uint32_t u, uint32_t k) {
      const auto l =
          static_cast<double>(plc::length(r.mesh.at(u) - r.mesh.at(r.mesh.neighbor(u, k))));
      CHECK(l > 0.999 * delta);
      CHECK(l < 2.501 * delta);
    });
    CHECK(samples::volume(r.mesh) == Approx(sphere_volume(kRadius)).epsilon(0.03));
  }
}

TEST_CASE("the result has ids without gaps in Morton order", "[recovery]") {
  const Recovered r = recover(ball_run(1));
  CHECK(r.mesh.slots() == r.mesh.vertex_count());
  const auto order = plc::morton_order(r.mesh);
  for (uint32_t v = 0; v < r.mesh.slots(); ++v) CHECK(order[v] == v);
}

TEST_CASE("without renumbering ids stay in the order in which they came, without gaps",
          "[recovery]") {
  Run run = ball_run(1);
  const Recovered usual = recover(run);
  run.recovery.renumbering = false;
  const Recovered r = recover(run);
  REQUIRE(r.status.ok());
  CHECK(samples::meeting_count(r.mesh) == 0);
  CHECK(plc::broken_invariant(r.mesh).empty());
  CHECK(r.mesh.slots() == r.mesh.vertex_count());
  const auto order = plc::morton_order(r.mesh);
  CHECK_FALSE(std::is_sorted(order.begin(), order.end()));
  CHECK(samples::volume(r.mesh) == Approx(samples::volume(usual.mesh)).epsilon(0.01));
}

TEST_CASE("without the rule of slow vertices every vertex is checked in every iteration",
          "[recovery]") {
  Run run = ball_run(0);
  run.recovery.slow_vertices = false;
  const Recovered r = recover(run);
  REQUIRE(r.status.ok());
  CHECK(samples::meeting_count(r.mesh) == 0);
  CHECK(plc::broken_invariant(r.mesh).empty());
  for (uint32_t v = 0; v < r.mesh.slots(); ++v) {
    CHECK(r.mesh.path[v] == 0);
  }
  CHECK(samples::volume(r.mesh) ==
        Approx(samples::volume(recover(ball_run(0)).mesh)).epsilon(0.01));
}

TEST_CASE("progress counts iterations from 1 on each level and never goes back", "[recovery]") {
  const Recovered r = recover(ball_run(2));
  REQUIRE(r.status.ok());
  double fraction = 0;
  int level = 2, iteration = 0;
  for (const RecoveryProgress& p : r.progress) {
    CHECK(p.levels == 2);
    if (p.level != level) {
      CHECK(p.level == level - 1);
      CHECK(iteration == r.records[static_cast<size_t>(2 - level)].iterations);
      level = p.level;
      iteration = 0;
    }
    CHECK(p.iteration == ++iteration);
    CHECK(p.vertices > 0);
    CHECK(p.energy >= 0);
    CHECK(p.fraction >= fraction);
    CHECK(p.fraction <= 1);
    fraction = p.fraction;
  }
  CHECK(level == 0);
}

TEST_CASE("a callback that says no ends the run at once", "[recovery]") {
  for (const size_t most : {size_t{1}, size_t{5}, size_t{40}}) {
    const Recovered r = recover(ball_run(2), most);
    CHECK(r.status.code() == ErrorCode::kCancelled);
    CHECK(r.progress.size() == most);
    CHECK(plc::broken_invariant(r.mesh) == "");
  }
}

TEST_CASE("the iteration cap ends a level that has not converged", "[recovery]") {
  Run run = ball_run(1);
  run.recovery.max_iterations = 7;
  const Recovered r = recover(run);
  REQUIRE(r.status.ok());
  for (const LevelRecord& record : r.records) {
    CHECK(record.iterations == 7);
    CHECK_FALSE(record.converged);
  }
  CHECK(samples::meeting_count(r.mesh) == 0);
}

TEST_CASE("a chain comes out as two rings from one bubble and from many", "[recovery]") {
  // 3.9
  Run run = samples::make_run(
      "chain", samples::chain_potential(samples::empty_volume({40, 40, 40})), 0.5, 0);
  run.recovery.model.curvature = 0.1F;
  run.recovery.model.spring = 0.01F;
  run.recovery.model.rest_length = plc::RestLength::kZero;
  for (const bool many : {false, true}) {
    if (many) {
      run.recovery.start.init = plc::Init::kBubbles;
      run.recovery.start.bubbles = {7, 7, 7};
      run.recovery.model.curvature = run.recovery.model.spring = 0;
    }
    const Recovered r = recover(run);
    REQUIRE(r.status.ok());
    CHECK(samples::component_count(r.mesh) == 2);
    CHECK(samples::euler(r.mesh) == 0);
    CHECK(samples::meeting_count(r.mesh) == 0);
    CHECK(r.records[0].operations.axial + r.records[0].operations.annular > 0);
  }
}

TEST_CASE("anisotropic voxels give the same ball with each method of 4.4", "[recovery]") {
  for (const plc::Anisotropy method :
       {plc::Anisotropy::kPhysical, plc::Anisotropy::kVoxel, plc::Anisotropy::kMetric}) {
    Run run = samples::make_run(
        "ball", samples::sphere_potential(samples::empty_volume({28, 28, 14}, {1, 1, 2}), 0.35),
        0.5, 1);
    run.recovery.model.curvature = 0.1F;
    run.recovery.scale.anisotropy = method;
    const Recovered r = recover(run);
    REQUIRE(r.status.ok());
    CHECK(samples::euler(r.mesh) == 2);
    const double to_mm = method == plc::Anisotropy::kPhysical ? 1 : 2;
    CHECK(samples::volume(r.mesh) * to_mm == Approx(sphere_volume(kRadius)).epsilon(0.05));
  }
}

TEST_CASE("an object that the border cuts comes out closed", "[recovery]") {
  Run run = ball_run(1);
  run.volume.values.assign(run.volume.values.size(), 1.0F);
  const Recovered r = recover(run);
  REQUIRE(r.status.ok());
  CHECK(samples::euler(r.mesh) == 2);
  CHECK(samples::volume(r.mesh) == Approx(28.0 * 28 * 28).epsilon(0.08));
}

TEST_CASE("an image with nothing of the object is an error that says so", "[recovery]") {
  Run run = ball_run(1);
  run.volume.values.assign(run.volume.values.size(), 0.2F);
  const Recovered r = recover(run);
  CHECK(r.status.code() == ErrorCode::kInvalidData);
  CHECK_THAT(r.status.message(), Catch::Matchers::Contains("no surface"));
  CHECK(r.mesh.vertex_count() == 0);
}

TEST_CASE("a surface that nothing holds vanishes, and that is an error", "[recovery]") {
  // A spot that strong internal forces shrink.
  Run run = samples::make_run(
      "spot", samples::sphere_potential(samples::empty_volume({20, 20, 20}), 0.06), 0.5, 0);
  run.recovery.model.spring = 2;
  run.recovery.model.rest_length = plc::RestLength::kZero;
  const Recovered r = recover(run);
  CHECK(r.status.code() == ErrorCode::kInvalidData);
  CHECK_THAT(r.status.message(), Catch::Matchers::Contains("no surface"));
}

TEST_CASE("levels on which the object does not show are passed over", "[recovery]") {
  // Thin walls: gone on the coarse levels at the value of I_0.
  Run run = samples::make_run("shell", samples::shell(samples::empty_volume({32, 32, 32})), 0.6, 3);
  run.recovery.model.curvature = 0.05F;
  const Recovered r = recover(run);
  REQUIRE(r.status.ok());
  REQUIRE(r.records.size() == 4);
  CHECK(r.records[0].level == 3);
  CHECK(r.records[0].iterations == 0);
  CHECK(r.records[0].vertices == 0);
  CHECK(r.records[3].level == 0);
  CHECK(r.records[3].iterations > 0);
  CHECK(samples::meeting_count(r.mesh) == 0);
}

TEST_CASE("more bubbles than the coarsest level has room for are refused", "[recovery]") {
  Run run = ball_run(2);
  run.recovery.start.init = plc::Init::kBubbles;
  run.recovery.start.bubbles = {30, 30, 30};
  const Recovered r = recover(run);
  CHECK(r.status.code() == ErrorCode::kInvalidArgument);
  CHECK_THAT(r.status.message(), Catch::Matchers::Contains("bubbles 30 x 30 x 30"));
}

TEST_CASE("mesh space has the voxels of the unpadded image at its integers, on every level",
          "[recovery]") {
  const Run run = samples::make_run(
      "ball", samples::sphere_potential(samples::empty_volume({21, 26, 33}, {1, 2, 1.5}), 0.3), 0.5,
      3);
  const plc::Pyramid pyramid = samples::pyramid_of(run);
  for (const plc::Anisotropy method :
       {plc::Anisotropy::kPhysical, plc::Anisotropy::kVoxel, plc::Anisotropy::kMetric}) {
    for (int h = 0; h <= 3; ++h) {
      const plc::MeshSpace space = plc::mesh_space(pyramid, h, method);
      const plc::ImageView view = plc::image_view(pyramid, h, 6, space);
      const plc::PyramidLevel& level = pyramid.levels[static_cast<size_t>(h)];
      for (size_t a = 0; a < 3; ++a) {
        CHECK(view.dims[a] == level.dims[a]);
        // (10): voxel i of a level of M covers [i, i + 1] / M of the padded extent.
        for (const double voxel : {-6.0, 0.0, 7.0, 20.0}) {
          const double part = (voxel + 6 + 0.5) / static_cast<double>(run.volume.dims[a] + 12);
          const double expected = part * static_cast<double>(level.dims[a]) - 0.5;
          const double mesh = voxel * space.step[a];
          CHECK(static_cast<double>(view.scale[a]) * mesh + static_cast<double>(view.offset[a]) ==
                Approx(expected).margin(1e-4));
        }
      }
    }
  }
}

TEST_CASE("a run from the same input twice in one mesh is the same", "[recovery]") {
  const Run run = ball_run(1);
  const Recovered first = recover(run);
  const plc::Schedule schedule(1);
  const plc::Pyramid pyramid = samples::pyramid_of(run);
  Mesh mesh;
  samples::fill_mesh(mesh, samples::torus(40, 30, 9, 3), 1);  // forgotten
  mesh.clear();
  std::vector<LevelRecord> records;
  REQUIRE(plc::pyramidal_recover_shape(pyramid, run.recovery, schedule, {}, mesh, records).ok());
  CHECK(samples::sorted_faces(mesh) == samples::sorted_faces(first.mesh));
}

TEST_CASE("a level that would have more vertices than there are ids is told before it starts",
          "[recovery]") {
  const plc::Schedule schedule(1);
  const Run run = ball_run(2);
  const plc::Pyramid pyramid = samples::pyramid_of(run);
  plc::Mesh mesh;
  std::vector<plc::LevelRecord> records;
  // Enough for the level before the last.
  mesh.most_vertices = recover(run).mesh.vertex_count() * 2 / 3;
  const plc::Status status =
      plc::pyramidal_recover_shape(pyramid, run.recovery, schedule, {}, mesh, records);
  CHECK(status.code() == plc::ErrorCode::kOutOfMemory);
  CHECK_THAT(status.message(), Catch::Contains("vertices at this resolution"));
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(records.size() == 3);
  CHECK(records[2].iterations == 0);
}
