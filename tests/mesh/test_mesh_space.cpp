#include "engine/mesh/mesh_space.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/samples/sample_runs.h"

namespace {

using plc::Anisotropy;
using plc::Mesh;
using plc::MeshSpace;

constexpr Anisotropy kMethods[] = {Anisotropy::kPhysical, Anisotropy::kVoxel, Anisotropy::kMetric};

// Levels of different proportions: the sizes of voxels are rounded on every axis (11).
plc::Pyramid anisotropic_pyramid() {
  const samples::Run run = samples::make_run(
      "ball", samples::sphere_potential(samples::empty_volume({41, 26, 17}, {0.8, 1.1, 3}), 0.3),
      0.5, 2);
  return plc::without_values(samples::pyramid_of(run));
}

std::array<double, 3> metric_of(const MeshSpace& space) {
  return {static_cast<double>(space.metric.x), static_cast<double>(space.metric.y),
          static_cast<double>(space.metric.z)};
}

}  // namespace

TEST_CASE("in physical space a mesh unit is U_0 on every axis, of every level", "[mesh_space]") {
  const plc::Pyramid pyramid = anisotropic_pyramid();
  const plc::PyramidLevel& finest = pyramid.levels[0];
  for (int h = 0; h <= 2; ++h) {
    const MeshSpace space = plc::mesh_space(pyramid, h, Anisotropy::kPhysical);
    for (size_t a = 0; a < 3; ++a) {
      CHECK(space.step[a] == Approx(finest.voxel[a] / finest.unit));
      CHECK(metric_of(space)[a] == 1);
    }
  }
}

TEST_CASE("in voxel space a mesh unit is a voxel of I_0, and so are the forces' lengths",
          "[mesh_space]") {
  const plc::Pyramid pyramid = anisotropic_pyramid();
  for (int h = 0; h <= 2; ++h) {
    const MeshSpace space = plc::mesh_space(pyramid, h, Anisotropy::kVoxel);
    for (size_t a = 0; a < 3; ++a) {
      CHECK(space.step[a] == 1);
      CHECK(metric_of(space)[a] == 1);
    }
  }
}

TEST_CASE(
    "in metric space a voxel of each level is as long on every axis, and the metric gives "
    "back its millimetres",
    "[mesh_space]") {
  const plc::Pyramid pyramid = anisotropic_pyramid();
  const plc::PyramidLevel& finest = pyramid.levels[0];
  for (int h = 0; h <= 2; ++h) {
    const plc::PyramidLevel& level = pyramid.levels[static_cast<size_t>(h)];
    const MeshSpace space = plc::mesh_space(pyramid, h, Anisotropy::kMetric);
    for (size_t a = 0; a < 3; ++a) {
      const double voxels_of_finest = level.voxel[a] / finest.voxel[a];
      CHECK(space.step[a] * voxels_of_finest == Approx(level.unit / finest.unit));
      CHECK(metric_of(space)[a] == Approx(level.voxel[a] / level.unit));
      // Both together: millimetres of a voxel of I_0, in U_0.
      CHECK(space.step[a] * metric_of(space)[a] == Approx(finest.voxel[a] / finest.unit));
    }
  }
}

TEST_CASE("with all methods the shortest side of a level's voxel is what delta goes by",
          "[mesh_space]") {
  const plc::Pyramid pyramid = anisotropic_pyramid();
  const plc::PyramidLevel& finest = pyramid.levels[0];
  for (const Anisotropy method : {Anisotropy::kPhysical, Anisotropy::kMetric}) {
    for (int h = 0; h <= 2; ++h) {
      const plc::PyramidLevel& level = pyramid.levels[static_cast<size_t>(h)];
      const MeshSpace space = plc::mesh_space(pyramid, h, method);
      double shortest = 1e30;
      for (size_t a = 0; a < 3; ++a) {
        shortest = std::min(shortest, level.voxel[a] / finest.voxel[a] * space.step[a]);
      }
      CHECK(shortest == Approx(level.unit / finest.unit).epsilon(0.06));  // (11) rounds
    }
  }
}

TEST_CASE("isotropic voxels make all three spaces the same", "[mesh_space]") {
  const samples::Run run = samples::make_run(
      "ball", samples::sphere_potential(samples::empty_volume({20, 20, 20}, {2, 2, 2})), 0.5, 1);
  const plc::Pyramid pyramid = samples::pyramid_of(run);
  for (const Anisotropy method : kMethods) {
    for (int h = 0; h <= 1; ++h) {
      const MeshSpace space = plc::mesh_space(pyramid, h, method);
      for (size_t a = 0; a < 3; ++a) {
        const double rounding = h == 0 ? 1e-6 : 0.06;  // (11)
        CHECK(space.step[a] == Approx(1).epsilon(rounding));
        CHECK(metric_of(space)[a] == Approx(1).epsilon(rounding));
        CHECK(space.step[a] * metric_of(space)[a] == Approx(1));
      }
    }
  }
}

TEST_CASE("a mesh goes to another space with its velocities, and back", "[mesh_space]") {
  const plc::Pyramid pyramid = anisotropic_pyramid();
  const MeshSpace from = plc::mesh_space(pyramid, 2, Anisotropy::kMetric);
  const MeshSpace to = plc::mesh_space(pyramid, 1, Anisotropy::kMetric);
  REQUIRE(from.step != to.step);
  Mesh mesh;
  samples::fill_mesh(mesh, samples::moved(samples::sphere(2), 9, 8, 7, 5), 1);
  for (uint32_t v = 0; v < mesh.slots(); ++v) mesh.velocity.set(v, {0.1F, -0.2F, 0.3F});
  std::vector<plc::Vec3> before;
  for (uint32_t v = 0; v < mesh.slots(); ++v) before.push_back(mesh.at(v));

  plc::change_space(mesh, from, to);
  CHECK(plc::broken_invariant(mesh) == "");
  const auto same_voxel = [](float a, double step_a, float b, double step_b) {
    return static_cast<double>(a) / step_a ==
           Approx(static_cast<double>(b) / step_b).epsilon(1e-5).margin(1e-6);
  };
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    CHECK(same_voxel(mesh.at(v).x, to.step[0], before[v].x, from.step[0]));
    CHECK(same_voxel(mesh.at(v).y, to.step[1], before[v].y, from.step[1]));
    CHECK(same_voxel(mesh.at(v).z, to.step[2], before[v].z, from.step[2]));
    CHECK(same_voxel(mesh.velocity.at(v).x, to.step[0], 0.1F, from.step[0]));
    CHECK(same_voxel(mesh.velocity.at(v).y, to.step[1], -0.2F, from.step[1]));
    CHECK(same_voxel(mesh.velocity.at(v).z, to.step[2], 0.3F, from.step[2]));
  }

  plc::change_space(mesh, to, from);
  for (uint32_t v = 0; v < mesh.slots(); ++v) {
    CHECK(plc::length(mesh.at(v) - before[v]) < 1e-5F);
    CHECK(mesh.velocity.at(v).z == Approx(0.3));
  }
}

TEST_CASE("deleted vertices do not hinder a change of space, and none is one without a trace",
          "[mesh_space]") {
  const plc::Pyramid pyramid = anisotropic_pyramid();
  const MeshSpace voxel = plc::mesh_space(pyramid, 0, Anisotropy::kVoxel);
  const MeshSpace metric = plc::mesh_space(pyramid, 0, Anisotropy::kMetric);
  samples::Soup soup = samples::moved(samples::sphere(1), 5, 5, 5, 3);
  soup.append(samples::moved(samples::sphere(1), 15, 5, 5, 3));
  Mesh mesh;
  samples::fill_mesh(mesh, soup, 1);
  for (uint32_t v = 0; v < 18; ++v) mesh.destroy(v);
  const plc::Vec3 before = mesh.at(20);
  plc::change_space(mesh, voxel, voxel);
  CHECK(plc::length(mesh.at(20) - before) == 0);
  plc::change_space(mesh, voxel, metric);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(mesh.at(20).x == Approx(static_cast<double>(before.x) * metric.step[0]));
}
