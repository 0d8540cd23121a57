#include "engine/start/crumbs.h"

#include <catch2/catch.hpp>
#include <utility>

#include "engine/guard/obstacles.h"
#include "engine/mesh/mesh_invariants.h"
#include "engine/start/iso_surface.h"
#include "tests/samples/sample_scenes.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using samples::BallScene;

constexpr double kCrumb = 1.6;    // 19 voxels
constexpr double kNoCrumb = 2.1;  // 33

// How many components of the scene's iso-surface are crumbs.
int64_t crumbs_of(const BallScene& scene, const plc::Obstacles* obstacles = nullptr) {
  const plc::ImageObject object{scene.view(), 0.5F, true};
  plc::Mesh mesh;
  REQUIRE(plc::iso_surface(object, samples::kSerial, mesh).ok());
  mesh.obstacles = obstacles;
  const uint32_t before = mesh.vertex_count();
  const int64_t deleted = plc::delete_crumbs(mesh, object);
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK((mesh.vertex_count() < before) == (deleted > 0));
  CHECK(mesh.vertex_count() > 0);
  CHECK(plc::delete_crumbs(mesh, object) == 0);
  return deleted;
}

}  // namespace

TEST_CASE("what holds fewer than 27 joined voxels is a crumb", "[crumbs]") {
  CHECK(crumbs_of(BallScene({{10, 12, 12, 7}, {30, 12, 12, kCrumb}, {22, 12, 12, kCrumb}})) == 2);
  CHECK(crumbs_of(BallScene({{10, 12, 12, 7}, {30, 12, 12, kNoCrumb}})) == 0);
  // Of anisotropic voxels, too: the ball has as few of them.
  CHECK(crumbs_of(BallScene({{10, 12, 12, 7}, {30, 12, 12, kNoCrumb}}, {1, 1, 0.5F})) == 1);
}

TEST_CASE("cavities are none, nor what has some, nor the largest of all", "[crumbs]") {
  CHECK(crumbs_of(BallScene({{12, 12, 12, 8}, {12, 12, 12, -2}})) == 0);
  BallScene hollow({{10, 12, 12, 7}});  // with 26 voxels around one that is empty
  for (int32_t i = 0; i < 27; ++i) hollow.at(30 + i % 3, 12 + i / 3 % 3, 12 + i / 9) = i != 13;
  CHECK(crumbs_of(hollow) == 0);
  CHECK(crumbs_of(BallScene({{20, 12, 12, kCrumb}})) == 0);
}

TEST_CASE("a crumb around an obstacle stays", "[crumbs]") {
  const BallScene scene({{10, 12, 12, 7}, {30, 12, 12, kCrumb}});
  const auto at = [](double x) {
    plc::Vector<double> xyz{x, 12, 12, x + 0.3, 12, 12, x, 12.3, 12, x, 12, 12.3};
    return plc::Obstacles(std::move(xyz), {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, 0,
                          samples::kSerial);
  };
  const plc::Obstacles inside = at(30), beside = at(22);
  CHECK(crumbs_of(scene, &inside) == 0);
  CHECK(crumbs_of(scene, &beside) == 1);
}
