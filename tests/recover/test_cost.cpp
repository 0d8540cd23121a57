#include "engine/recover/cost.h"

#include <catch2/catch.hpp>

#include "engine/base/constants.h"
#include "tests/samples/sample_recovery.h"

namespace {

using plc::Anisotropy;

samples::Run ball(std::array<double, 3> spacing = {1, 1, 1}) {
  samples::Run run = samples::make_run(
      "ball", samples::sphere_potential(samples::empty_volume({40, 40, 40}, spacing), 0.35), 0.5,
      1);
  return run;
}

plc::Cost cost_of(const samples::Run& run, Anisotropy anisotropy, bool from_iso = false) {
  return plc::expected_cost(samples::pyramid_of(run), run.recovery.isos, run.recovery.inside_above,
                            run.recovery.pad_voxels, {anisotropy}, from_iso, samples::kSerial);
}

}  // namespace

TEST_CASE("what a run will cost is told within a third before it starts", "[cost]") {
  const samples::Run run = ball();
  const samples::Recovered r = samples::recover(run);
  REQUIRE(r.status.ok());
  const plc::Cost cost = cost_of(run, run.recovery.scale.anisotropy);
  CHECK(cost.vertices == Approx(r.mesh.vertex_count()).epsilon(0.33));
  CHECK(cost.voxels == 40 * 40 * 40);
  CHECK(cost.bytes > 200 * cost.vertices);
  const plc::Cost from_iso = cost_of(run, run.recovery.scale.anisotropy, true);
  CHECK(from_iso.vertices == cost.vertices);
  CHECK(from_iso.bytes > 2 * cost.bytes);
}

TEST_CASE("no image has room for more vertices than so many for each voxel", "[cost]") {
  for (const double side : {1.0, 10.0, 1e3, 1e5}) {
    const plc::Pyramid pyramid = samples::pyramid_of(ball({1, 1, side}));
    for (const Anisotropy method :
         {Anisotropy::kPhysical, Anisotropy::kVoxel, Anisotropy::kMetric}) {
      for (int h = 0; h <= 1; ++h) {
        const auto& dims = pyramid.levels[static_cast<size_t>(h)].dims;
        const auto voxels = static_cast<double>(dims[0] * dims[1] * dims[2]);
        const double most = plc::most_vertices(pyramid, h, plc::kPadVoxels, {method});
        CAPTURE(side, static_cast<int>(method), h);
        CHECK(most >= 1.7 * voxels);
        CHECK(most <= 1.8 * plc::kCubesPerVoxel * voxels);
      }
    }
  }
}

TEST_CASE("voxels up to 1 : 1 : 8 leave the mesh in millimetres as fine as the paper has it",
          "[cost]") {
  const plc::Pyramid near = samples::pyramid_of(ball({1, 1, 7.9})),
                     far = samples::pyramid_of(ball({1, 1, 320}));
  CHECK(plc::level_delta(near, 0, {Anisotropy::kPhysical}) == Approx(1 / plc::kUnitPerDelta));
  CHECK(plc::level_delta(far, 0, {Anisotropy::kPhysical}) == Approx(4 / plc::kUnitPerDelta));
  CHECK(plc::level_delta(far, 0, {Anisotropy::kVoxel}) == Approx(1 / plc::kUnitPerDelta));
}

TEST_CASE("a surface that its forces drive out of the image for ever is an error that says so",
          "[cost]") {
  samples::Run run = ball();
  run.recovery.force = [](int, const plc::MeshSpace&, const plc::Mesh& mesh, const plc::Float4*,
                          plc::Streams3& force) {
    for (uint32_t v = 0; v < mesh.slots(); ++v) force.set(v, mesh.normal.at(v) * 2.0F);
    return plc::Status();
  };
  run.recovery.max_iterations = 100000;
  const samples::Recovered r = samples::recover(run);
  CHECK(r.status.code() == plc::ErrorCode::kInvalidData);
  CHECK_THAT(r.status.message(),
             Catch::Matchers::Contains("vertices, the image has room for ") &&
                 Catch::Matchers::EndsWith("its forces drive it on without end"));
}
