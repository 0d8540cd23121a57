#include "engine/start/stretched_bubble.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/start/initial_surface.h"
#include "engine/start/level_start.h"
#include "tests/samples/sample_runs.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Mesh;

// Vertices for each square delta of the surface.
double density(const Mesh& mesh) {
  const auto faces = mesh.faces();
  double area = 0;
  for (size_t i = 0; i < faces.size(); i += 3) {
    area +=
        static_cast<double>(plc::length(plc::cross(mesh.at(faces[i + 1]) - mesh.at(faces[i]),
                                                   mesh.at(faces[i + 2]) - mesh.at(faces[i])))) /
        2;
  }
  return mesh.vertex_count() * mesh.delta * mesh.delta / area;
}

}  // namespace

TEST_CASE("a long, flat or thin bubble is one closed surface that is as fine as it should be",
          "[stretched_bubble]") {
  const plc::Schedule schedule(1);
  for (const std::array<double, 3>& half :
       {std::array<double, 3>{2, 200, 2}, std::array<double, 3>{3, 60, 90},
        std::array<double, 3>{22, 2.5, 2.5}}) {
    for (const int power : {2, 4}) {
      // The rim of a flat ellipsoid is thinner than (3) allows: it is torn.
      if (power == 2 && half[1] > 4 * half[0] && half[2] > 4 * half[0]) continue;
      REQUIRE(plc::is_stretched(half));
      Mesh mesh;
      REQUIRE(plc::make_stretched_bubble(mesh, {5, -7, 11}, half, power, 0.83, schedule).ok());
      CAPTURE(half[0], half[1], half[2], power);
      CHECK(plc::broken_invariant(mesh) == "");
      CHECK(mesh.delta == 0.83);
      CHECK(samples::euler(mesh) == 2);
      CHECK(samples::component_count(mesh) == 1);
      CHECK(samples::meeting_count(mesh) == 0);
      CHECK(density(mesh) < 0.5);
      const double box = 8 * half[0] * half[1] * half[2];
      CHECK(samples::volume(mesh) > 0.3 * box);
      CHECK(samples::volume(mesh) < 1.1 * box);
    }
  }
}

TEST_CASE("the bubble around a long image, and a ball of millimetres in flat voxels, are no denser",
          "[stretched_bubble]") {
  const plc::Schedule schedule(1);
  samples::Run run = samples::make_run(
      "rod", samples::sphere_potential(samples::empty_volume({8, 300, 8}), 0.3), 0.5, 0);
  const plc::Pyramid pyramid = samples::pyramid_of(run);
  plc::StartSpec start;
  const plc::LevelImage level{pyramid, 0, run.recovery.pad_voxels, {}, {}, true};
  for (const plc::Init init : {plc::Init::kBubble, plc::Init::kSeeds}) {
    start.init = init;
    start.seeds = {{{4, 150, 4}, {3, 40, 3}}};
    Mesh mesh;
    plc::OperationCounts counts;
    REQUIRE(plc::start_surface(start, level, 0.83, schedule, mesh, counts, {}).ok());
    CHECK(samples::component_count(mesh) == 1);
    CHECK(density(mesh) < 0.5);
  }
}
