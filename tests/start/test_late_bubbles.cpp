#include "engine/start/late_bubbles.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/mesh/state_hash.h"
#include "pyramid/memory.h"
#include "tests/samples/sample_scenes.h"
#include "tests/samples/sample_sides.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_woken.h"

namespace {

using plc::LateBubbles;
using plc::Mesh;
using plc::Vec3;
using plc::VoxelSet;
using samples::Ball;
using samples::BallScene;

constexpr float kIso = 0.5F;
constexpr double kDelta = 1 / plc::kUnitPerDelta;
const Ball kMain{10, 12, 12, 7};

double ball_volume(double r) {
  return 4.0 / 3 * 3.14159265358979 * r * r * r;
}

void surface_around(Mesh& mesh, const Ball& b) {
  samples::fill_mesh(mesh, samples::moved(samples::sphere(3), b.x, b.y, b.z, b.radius), kDelta);
}

// Starts what is missed, and checks what is always so.
LateBubbles start(Mesh& mesh, const BallScene& scene, VoxelSet& tried, int threads = 1,
                  bool above = true) {
  const plc::Schedule schedule(threads);
  LateBubbles started;
  plc::OperationCounts counts;
  const plc::ImageObject object{scene.view(), kIso, above};
  const plc::MissedPlaces places =
      plc::find_late_places(mesh, object, schedule, tried, plc::whole_room(scene.view()));
  REQUIRE(plc::start_late_bubbles(object, places, schedule, mesh, started, counts).message() == "");
  CHECK(plc::broken_invariant(mesh) == "");
  CHECK(samples::meeting_count(mesh) == 0);
  CHECK(mesh.delta == kDelta);
  return started;
}

LateBubbles start(Mesh& mesh, const BallScene& scene) {
  VoxelSet tried;
  return start(mesh, scene, tried);
}

// Voxels on the wrong side, of those where the image is not nearly iso.
size_t wrong_voxels(const Mesh& mesh, const BallScene& scene) {
  const plc::Vector<uint8_t> inside = samples::sides_of(mesh, scene.view());
  size_t wrong = 0;
  for (size_t i = 0; i < inside.size(); ++i) {
    if (std::abs(scene.values[i] - kIso) < 0.2F) continue;
    wrong += (inside[i] != 0) != (scene.values[i] > kIso) ? 1 : 0;
  }
  return wrong;
}

// How near the vertices of the start (ids below `old`) are to the others.
float nearest_to_old(const Mesh& mesh, uint32_t old) {
  float nearest = 1e30F;
  for (uint32_t v = old; v < mesh.slots(); ++v) {
    for (uint32_t u = 0; u < old; ++u) {
      nearest = std::min(nearest, plc::length(mesh.at(u) - mesh.at(v)));
    }
  }
  return nearest;
}

void fill_box(BallScene& scene, std::array<int32_t, 3> low, std::array<int32_t, 3> high,
              float value) {
  for (int32_t z = low[2]; z <= high[2]; ++z) {
    for (int32_t y = low[1]; y <= high[1]; ++y) {
      for (int32_t x = low[0]; x <= high[0]; ++x) scene.at(x, y, z) = value;
    }
  }
}

}  // namespace

TEST_CASE("a bubble leaves out the sheets of its place that are thinner than kThinSheet",
          "[late_bubbles]") {
  // A fin whose sides are 1 / (1 - v) voxels apart: more than (3) asks for, at 1.2.
  for (const float v : {0.25F, 0.4F}) {
    BallScene scene({kMain, {28, 12, 12, 4}});
    for (const int32_t x : {27, 28, 29}) {
      for (int32_t z = 2; z < 22; ++z) {
        for (int32_t y = 2; y < 22; ++y) {
          float& value = scene.at(x, y, z);
          value = std::max(value, x == 28 ? 1 : v);
        }
      }
    }
    Mesh mesh;
    surface_around(mesh, kMain);
    const uint32_t old = mesh.slots();
    REQUIRE(start(mesh, scene).bubbles == 1);
    float farthest = 0;
    for (uint32_t u = old; u < mesh.slots(); ++u) {
      farthest = std::max(farthest, std::abs(mesh.at(u).y - 12));
    }
    const bool thin = 1 / (1 - v) < plc::kThinSheet * static_cast<float>(kDelta);
    CAPTURE(v);
    CHECK(thin == (v < 0.3F));
    CHECK((farthest < 8) == thin);
  }
}

TEST_CASE("where nothing is missed the mesh stays as it is", "[late_bubbles]") {
  const BallScene scene({kMain});
  Mesh mesh;
  surface_around(mesh, kMain);
  const uint64_t before = plc::state_hash(mesh);
  const LateBubbles started = start(mesh, scene);
  CHECK(plc::state_hash(mesh) == before);
  CHECK(started.bubbles == 0);
  CHECK(started.cavities == 0);
  CHECK(started.volume == 0);
}

TEST_CASE("a missed part gets a surface of its own shape, faces outward, apart from the rest",
          "[late_bubbles]") {
  const BallScene scene({kMain, {28, 12, 12, 4}});
  Mesh mesh;
  surface_around(mesh, kMain);
  const uint32_t old = mesh.slots();
  const double before = samples::volume(mesh);
  CHECK(wrong_voxels(mesh, scene) > 100);
  const samples::Woken woken(mesh);
  const LateBubbles started = start(mesh, scene);
  CHECK(started.bubbles == 1);
  CHECK(started.cavities == 0);
  CHECK(samples::component_count(mesh) == 2);
  CHECK(samples::euler(mesh) == 4);
  CHECK(samples::volume(mesh) - before == Approx(ball_volume(4)).epsilon(0.12));
  CHECK(started.volume == Approx(samples::volume(mesh) - before).epsilon(1e-4));
  CHECK(wrong_voxels(mesh, scene) == 0);
  CHECK(nearest_to_old(mesh, old) > plc::kMinApart * static_cast<float>(kDelta));
  for (uint32_t v = old; v < mesh.slots(); ++v) {
    CHECK(plc::length(mesh.at(v) - Vec3{28, 12, 12}) == Approx(4).margin(0.9));
    CHECK(plc::length(mesh.velocity.at(v)) == 0);
    CHECK(woken[v]);
  }
}

TEST_CASE("a missed cavity gets a wall that faces inward", "[late_bubbles]") {
  const BallScene scene({{12, 12, 12, 10}, {12, 12, 12, -4}});
  Mesh mesh;
  surface_around(mesh, {12, 12, 12, 10});
  const double before = samples::volume(mesh);
  const LateBubbles started = start(mesh, scene);
  CHECK(started.bubbles == 0);
  CHECK(started.cavities == 1);
  CHECK(started.volume == Approx(ball_volume(4)).epsilon(0.12));
  CHECK(samples::volume(mesh) == Approx(before - started.volume).epsilon(1e-4));
  CHECK(samples::component_count(mesh) == 2);
  CHECK(wrong_voxels(mesh, scene) == 0);
}

TEST_CASE("a thin cavity gets a whole wall in an adaptive mesh", "[late_bubbles]") {
  BallScene scene({{20, 12, 12, 30}});
  fill_box(scene, {5, 12, 12}, {34, 12, 12}, 0);
  const plc::Schedule schedule(1);
  plc::Sizing sizing;
  sizing.object = {scene.view(), kIso, true};
  sizing.full_image = true;
  REQUIRE(sizing.field.build(scene.view(), kIso, kDelta, {}, schedule).ok());
  for (int32_t x = 5; x <= 34; ++x) sizing.field.lower({x, 12, 12}, plc::kThinSize, 1);
  sizing.field.bound_slope();
  Mesh mesh;
  mesh.sizing = &sizing;
  samples::fill_mesh(mesh, samples::moved(samples::sphere(3), 20, 12, 12, 40), kDelta);
  const uint32_t old = mesh.slots();
  CHECK(start(mesh, scene).cavities == 1);
  CHECK(samples::component_count(mesh) == 2);
  CHECK(samples::euler(mesh) == 4);
  float low = 40, high = 0;
  for (uint32_t v = old; v < mesh.slots(); ++v) {
    low = std::min(low, mesh.at(v).x);
    high = std::max(high, mesh.at(v).x);
  }
  CHECK(low == Approx(5).margin(0.5));
  CHECK(high == Approx(34).margin(0.5));
}

TEST_CASE("late bubbles of an adaptive mesh start with its edges, whatever delta is",
          "[late_bubbles]") {
  const BallScene scene({kMain, {34, 12, 12, 8}});
  const plc::ImageObject object{scene.view(), kIso, true};
  const plc::Schedule schedule(1);
  for (const double delta : {kDelta / 1.5, 1.5 * kDelta}) {
    plc::Sizing sizing;
    sizing.object = object;
    REQUIRE(sizing.field.build(scene.view(), kIso, delta, {}, schedule).ok());
    Mesh mesh;
    mesh.sizing = &sizing;
    samples::fill_mesh(mesh, samples::moved(samples::sphere(3), 10, 12, 12, 7), delta);
    const uint32_t old = mesh.slots();
    VoxelSet tried;
    const plc::MissedPlaces places =
        plc::find_late_places(mesh, object, schedule, tried, plc::whole_room(scene.view()));
    LateBubbles started;
    plc::OperationCounts counts;
    REQUIRE(plc::start_late_bubbles(object, places, schedule, mesh, started, counts).ok());
    CHECK(started.bubbles == 1);
    CAPTURE(delta, mesh.slots() - old);
    CHECK(counts.transformations() * 2 < mesh.slots() - old);
  }
}

TEST_CASE("parts and cavities are started together and counted each", "[late_bubbles]") {
  const BallScene scene({{12, 12, 12, 10}, {12, 12, 12, -4}, {31, 7, 12, 4}, {31, 18, 12, 3.5}});
  Mesh mesh;
  surface_around(mesh, {12, 12, 12, 10});
  const LateBubbles started = start(mesh, scene);
  CHECK(started.bubbles == 2);
  CHECK(started.cavities == 1);
  CHECK(started.volume == Approx(2 * ball_volume(4) + ball_volume(3.5)).epsilon(0.12));
  CHECK(samples::component_count(mesh) == 4);
  CHECK(wrong_voxels(mesh, scene) == 0);
}

TEST_CASE("dark objects get bubbles where the image is below iso", "[late_bubbles]") {
  BallScene scene({{12, 12, 12, 10}, {12, 12, 12, -4}, {31, 7, 12, 4}});
  for (float& v : scene.values) v = 1 - v;
  Mesh mesh;
  surface_around(mesh, {12, 12, 12, 10});
  VoxelSet tried;
  const LateBubbles started = start(mesh, scene, tried, 1, false);
  CHECK(started.bubbles == 1);
  CHECK(started.cavities == 1);
  CHECK(samples::component_count(mesh) == 3);
}

TEST_CASE("a plate of two or three voxels gets a plate, not a ball", "[late_bubbles]") {
  for (const int32_t thick : {2, 3}) {
    BallScene scene({kMain});
    fill_box(scene, {28, 3, 3}, {27 + thick, 20, 20}, 1);
    Mesh mesh;
    surface_around(mesh, kMain);
    const uint32_t old = mesh.slots();
    const LateBubbles started = start(mesh, scene);
    CAPTURE(thick);
    CHECK(started.bubbles == 1);
    CHECK(started.volume == Approx(18.0 * 18 * thick).epsilon(0.25));
    CHECK(samples::component_count(mesh) == 2);
    CHECK(samples::euler(mesh) == 4);
    Vec3 low{1e9F, 1e9F, 1e9F}, high{-1e9F, -1e9F, -1e9F};
    for (uint32_t v = old; v < mesh.slots(); ++v) {
      const Vec3 p = mesh.at(v);
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    CHECK(high.x - low.x == Approx(thick).margin(1.0));
    CHECK(high.y - low.y == Approx(18).margin(1.5));
    CHECK(high.z - low.z == Approx(18).margin(1.5));
  }
}

TEST_CASE("what the mesh cannot resolve gets nothing", "[late_bubbles]") {
  BallScene scene({kMain});
  fill_box(scene, {30, 3, 3}, {30, 20, 20}, 1);  // a sheet of one voxel
  fill_box(scene, {25, 12, 12}, {26, 12, 12}, 1);
  Mesh mesh;
  surface_around(mesh, kMain);
  const uint32_t old = mesh.slots();
  CHECK(start(mesh, scene).bubbles == 0);
  CHECK(mesh.slots() == old);
}

TEST_CASE("what was tried once is not started again, though it is missed still", "[late_bubbles]") {
  const BallScene scene({kMain, {28, 12, 12, 4}});
  Mesh mesh;
  surface_around(mesh, kMain);
  VoxelSet tried;
  CHECK(start(mesh, scene, tried).bubbles == 1);
  Mesh again;
  surface_around(again, kMain);
  CHECK(start(again, scene, tried).bubbles == 0);
  // With a surface there nothing is missed any more either.
  VoxelSet fresh;
  CHECK(start(mesh, scene, fresh).bubbles == 0);
}

TEST_CASE("a part next to the surface starts apart from it", "[late_bubbles]") {
  // The surface lies 2.2 within the object's: too near for a place; the second ball overlaps that.
  const BallScene scene({kMain, {21.5, 12, 12, 5}});
  Mesh mesh;
  surface_around(mesh, kMain);
  const uint32_t old = mesh.slots();
  CHECK(start(mesh, scene).bubbles == 1);
  CHECK(nearest_to_old(mesh, old) > plc::kMinApart * static_cast<float>(kDelta));
}

TEST_CASE("a part that the border cuts is closed there", "[late_bubbles]") {
  const BallScene scene({kMain, {39, 12, 12, 5}});
  Mesh mesh;
  surface_around(mesh, kMain);
  const LateBubbles started = start(mesh, scene);
  CHECK(started.bubbles == 1);
  CHECK(started.volume == Approx(ball_volume(5) / 2 + 0.5 * 3.14159265 * 25).epsilon(0.2));
  CHECK(samples::euler(mesh) == 4);
}

TEST_CASE("bubbles have the image's shape where voxels are not cubes", "[late_bubbles]") {
  for (const std::array<float, 3>& scale :
       {std::array{1.0F, 1.0F, 0.5F}, std::array{1.0F, 2.0F, 1.0F}}) {
    const BallScene scene({kMain, {28, 12, 12, 5}}, scale);
    Mesh mesh;
    surface_around(mesh, kMain);
    const LateBubbles started = start(mesh, scene);
    CHECK(started.bubbles == 1);
    CHECK(started.volume == Approx(ball_volume(5)).epsilon(0.15));
  }
}

TEST_CASE("late bubbles have the same bits for any number of threads", "[late_bubbles]") {
  const BallScene scene({{12, 12, 12, 10}, {12, 12, 12, -4}, {31, 7, 12, 4}, {31, 18, 12, 3.5}});
  std::vector<uint64_t> hashes;
  std::vector<double> volumes;
  for (const int threads : {1, 2, 3}) {
    Mesh mesh;
    surface_around(mesh, {12, 12, 12, 10});
    VoxelSet tried;
    volumes.push_back(start(mesh, scene, tried, threads).volume);
    hashes.push_back(plc::state_hash(mesh));
  }
  for (const size_t i : std::initializer_list<size_t>{1, 2}) {
    CHECK(hashes[i] == hashes[0]);
    CHECK(volumes[i] == volumes[0]);
  }
}
