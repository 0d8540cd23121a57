#include "engine/start/missed_places.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "engine/base/constants.h"
#include "engine/base/schedule.h"
#include "tests/samples/sample_scenes.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::Mesh;
using plc::Missed;
using plc::MissedPlaces;
using plc::PlaceLimits;
using plc::Voxel;
using plc::VoxelSet;
using samples::Ball;
using samples::BallScene;

constexpr float kIso = 0.5F;
constexpr float kClearance = 2;
constexpr float kRadius = 1.2F;

void surface_around(Mesh& mesh, const Ball& b) {
  samples::fill_mesh(mesh, samples::moved(samples::sphere(3), b.x, b.y, b.z, b.radius), 1);
}

MissedPlaces find(const Mesh& mesh, const BallScene& scene, VoxelSet& tried,
                  const PlaceLimits& limits = {kClearance, kRadius}) {
  return plc::find_missed_places(mesh, {scene.view(), kIso, true}, limits, samples::kSerial, tried,
                                 plc::whole_room(scene.view()));
}

MissedPlaces find(const Mesh& mesh, const BallScene& scene,
                  const PlaceLimits& limits = {kClearance, kRadius}) {
  VoxelSet tried;
  return find(mesh, scene, tried, limits);
}

std::vector<Voxel> all_of(const VoxelSet& set) {
  std::vector<Voxel> all;
  set.visit([&](const Voxel& v) { all.push_back(v); });
  return all;
}

std::vector<Voxel> all_of(const MissedPlaces& places, Missed kind) {
  return all_of(places.voxels[static_cast<size_t>(kind)]);
}

size_t voxels_of(const MissedPlaces& places, Missed kind) {
  return all_of(places, kind).size();
}

constexpr size_t kPart = 0, kCavity = 1;
const Ball kMain{10, 12, 12, 7};

}  // namespace

TEST_CASE("a surface around all of the object misses nothing", "[missed_places]") {
  const BallScene scene({kMain});
  Mesh mesh;
  surface_around(mesh, kMain);
  const MissedPlaces places = find(mesh, scene);
  CHECK(places.count == std::array<int64_t, 2>{0, 0});
  CHECK(voxels_of(places, Missed::kPart) + voxels_of(places, Missed::kCavity) == 0);
  for (const size_t k : {kPart, kCavity}) CHECK(places.low[k][0] > places.high[k][0]);
}

TEST_CASE("a ball beside the surface is one missed part, with all its voxels and their box",
          "[missed_places]") {
  const Ball second{28, 12, 11, 4};
  const BallScene scene({kMain, second});
  Mesh mesh;
  surface_around(mesh, kMain);
  const MissedPlaces places = find(mesh, scene);
  CHECK(places.count == std::array<int64_t, 2>{1, 0});
  for (int32_t z = 0; z < 24; ++z) {
    for (int32_t y = 0; y < 24; ++y) {
      for (int32_t x = 0; x < 40; ++x) {
        const bool in = samples::norm(x - second.x, y - second.y, z - second.z) <= second.radius;
        if (places.is({x, y, z}, Missed::kPart) != in) FAIL("voxel " << x << " " << y << " " << z);
      }
    }
  }
  CHECK(places.low[kPart] == std::array<int32_t, 3>{24, 8, 7});
  CHECK(places.high[kPart] == std::array<int32_t, 3>{32, 16, 15});
}

TEST_CASE("a hole that the surface encloses is a missed cavity, not a part", "[missed_places]") {
  const BallScene scene({{12, 12, 12, 10}, {12, 12, 12, -4}});
  Mesh mesh;
  surface_around(mesh, {12, 12, 12, 10});
  const MissedPlaces places = find(mesh, scene);
  CHECK(places.count == std::array<int64_t, 2>{0, 1});
  CHECK(voxels_of(places, Missed::kPart) == 0);
  CHECK(static_cast<double>(voxels_of(places, Missed::kCavity)) ==
        Approx(4.0 / 3 * 3.14159265 * 64).epsilon(0.1));
  CHECK(places.low[kCavity][0] >= 8);
  CHECK(places.high[kCavity][0] <= 16);
}

TEST_CASE("dark objects in bright images are told by the other side of iso", "[missed_places]") {
  const Ball second{28, 12, 12, 4};
  BallScene scene({kMain, second});
  Mesh mesh;
  surface_around(mesh, kMain);
  VoxelSet bright_tried;
  const MissedPlaces bright = find(mesh, scene, bright_tried);
  for (float& v : scene.values) v = 1 - v;
  VoxelSet tried;
  const MissedPlaces dark =
      plc::find_missed_places(mesh, {scene.view(), kIso, false}, {kClearance, kRadius},
                              samples::kSerial, tried, plc::whole_room(scene.view()));
  CHECK(dark.count == std::array<int64_t, 2>{1, 0});
  CHECK(all_of(dark, Missed::kPart) == all_of(bright, Missed::kPart));
}

TEST_CASE("what is within the clearance of a vertex is the surface's own matter",
          "[missed_places]") {
  // 3 mesh units of object beyond the surface all around.
  const BallScene scene({{12, 12, 12, 9}});
  Mesh mesh;
  surface_around(mesh, {12, 12, 12, 6});
  CHECK(find(mesh, scene, {4, kRadius}).count[kPart] == 0);
  // With less of it a shell is left over, which holds a small ball only.
  CHECK(find(mesh, scene, {0.9F, 0.3F}).count[kPart] == 1);
  CHECK(find(mesh, scene, {0.9F, 1.2F}).count[kPart] == 0);
}

TEST_CASE("places that hold no ball of the radius are left out, whatever their extent",
          "[missed_places]") {
  const Ball second{28, 12, 12, 4};
  const BallScene scene({kMain, second});
  Mesh mesh;
  surface_around(mesh, kMain);
  CHECK(find(mesh, scene, {kClearance, 3}).count[kPart] == 1);
  CHECK(find(mesh, scene, {kClearance, 5}).count[kPart] == 0);
  // A sheet of one voxel, larger than the ball: nothing for 0.6, enough for 0.4.
  BallScene sheet({kMain});
  for (int32_t z = 2; z < 22; ++z) {
    for (int32_t y = 2; y < 22; ++y) sheet.at(30, y, z) = 1;
  }
  CHECK(find(mesh, sheet, {kClearance, 0.6F}).count[kPart] == 0);
  CHECK(find(mesh, sheet, {kClearance, 0.4F}).count[kPart] == 1);
}

TEST_CASE("what is thin of a place gets no bubble, but for what is beside its thick part",
          "[missed_places]") {
  // A ball with a fin of one voxel, where the image falls from 1 to 0: the iso-surface has sides 1
  // voxel apart.
  BallScene scene({kMain, {28, 12, 12, 4}});
  for (int32_t z = 2; z < 22; ++z) {
    for (int32_t y = 2; y < 22; ++y) scene.at(28, y, z) = 1;
  }
  Mesh mesh;
  surface_around(mesh, kMain);
  VoxelSet tried;
  const MissedPlaces whole = find(mesh, scene, {kClearance, kRadius, 0.99F});
  const MissedPlaces thick = find(mesh, scene, tried, {kClearance, kRadius, 1.8F});
  CHECK(whole.is({28, 2, 2}, Missed::kPart));
  CHECK(whole.low[kPart] == Voxel{24, 2, 2});
  CHECK(whole.high[kPart] == Voxel{32, 21, 21});
  REQUIRE(thick.count[kPart] == 1);
  CHECK(thick.is({28, 12, 12}, Missed::kPart));
  CHECK(thick.is({28, 8, 12}, Missed::kPart));
  CHECK_FALSE(thick.is({28, 4, 12}, Missed::kPart));
  CHECK(thick.low[kPart][1] > 5);
  CHECK(thick.high[kPart][1] < 19);
  // All of it has been tried.
  CHECK(tried.has({28, 2, 2}));
  // Nowhere as thick.
  CHECK(find(mesh, scene, {kClearance, kRadius, 12}).count[kPart] == 0);
}

TEST_CASE("a ball between the voxels' centres fits as well as one about a centre",
          "[missed_places]") {
  // 2 x 2 x 2 voxels hold a ball of just under 1 about their corner, none about a centre.
  BallScene scene({kMain});
  for (const int32_t z : {12, 13}) {
    for (const int32_t y : {12, 13}) {
      for (const int32_t x : {30, 31}) scene.at(x, y, z) = 1;
    }
  }
  Mesh mesh;
  surface_around(mesh, kMain);
  CHECK(find(mesh, scene, {kClearance, 0.99F}).count[kPart] == 1);
  CHECK(find(mesh, scene, {kClearance, 1.01F}).count[kPart] == 0);
}

TEST_CASE("parts that touch by a corner of a voxel are one, parts a voxel apart are two",
          "[missed_places]") {
  for (const int32_t gap : {0, 1}) {
    BallScene scene({kMain});
    const auto block = [&](int32_t from) {
      for (int32_t z = from; z < from + 4; ++z) {
        for (int32_t y = from; y < from + 4; ++y) {
          for (int32_t x = 20 + from; x < 24 + from; ++x) {
            scene.at(x, y, z) = 1;
          }
        }
      }
    };
    block(6);
    block(10 + gap);
    Mesh mesh;
    surface_around(mesh, kMain);
    const MissedPlaces places = find(mesh, scene);
    CHECK(places.count[kPart] == 1 + gap);
    CHECK(voxels_of(places, Missed::kPart) == 128);
  }
}

TEST_CASE("a place that was tried is not found again, a new one is", "[missed_places]") {
  const Ball second{28, 12, 12, 4};
  Mesh mesh;
  surface_around(mesh, kMain);
  VoxelSet tried;
  const BallScene scene({kMain, second});
  CHECK(find(mesh, scene, tried).count[kPart] == 1);
  CHECK(all_of(tried).size() > 200);
  const MissedPlaces again = find(mesh, scene, tried);
  CHECK(again.count[kPart] == 0);
  CHECK(voxels_of(again, Missed::kPart) == 0);
  // One voxel in common is enough to know it by.
  CHECK(find(mesh, BallScene({kMain, {31, 12, 12, 4}}), tried).count[kPart] == 0);
  const MissedPlaces other = find(mesh, BallScene({kMain, second, {28, 4, 4, 3}}), tried);
  CHECK(other.count[kPart] == 1);
  CHECK(other.high[kPart][1] < 8);
}

TEST_CASE("places left out for their size are not marked as tried", "[missed_places]") {
  const BallScene scene({kMain, {28, 12, 12, 4}});
  Mesh mesh;
  surface_around(mesh, kMain);
  VoxelSet tried;
  CHECK(find(mesh, scene, tried, {kClearance, 6}).count[kPart] == 0);
  CHECK(find(mesh, scene, tried).count[kPart] == 1);
}

TEST_CASE("lengths are those of mesh space when voxels are not cubes", "[missed_places]") {
  // Three times as many voxels along z: the balls are the same in mesh units.
  const Ball second{28, 12, 12, 4};
  const BallScene fine({kMain, second}, {1, 1, 3});
  Mesh mesh;
  surface_around(mesh, kMain);
  CHECK(find(mesh, fine).count == std::array<int64_t, 2>{1, 0});
  CHECK(find(mesh, fine, {kClearance, 3}).count[kPart] == 1);
  CHECK(find(mesh, fine, {kClearance, 5}).count[kPart] == 0);
  // Near in mesh units, though twelve voxels away.
  const BallScene grown({{10, 12, 12, 9}}, {1, 1, 3});
  CHECK(find(mesh, grown, {4, kRadius}).count[kPart] == 0);
}

TEST_CASE("an object at the border is found, its ball must lie within the image",
          "[missed_places]") {
  const BallScene scene({kMain, {39, 12, 12, 6}});
  Mesh mesh;
  surface_around(mesh, kMain);
  CHECK(find(mesh, scene).count[kPart] == 1);
  CHECK(find(mesh, scene).high[kPart][0] == 39);
  const BallScene sliver({kMain, {42, 12, 12, 4}});  // 2 voxels deep at most
  CHECK(find(mesh, sliver, {kClearance, 1.6F}).count[kPart] == 0);
}

TEST_CASE("missed places are the same for any number of threads", "[missed_places]") {
  const BallScene scene({{12, 12, 12, 10}, {12, 12, 12, -5}, {30, 8, 8, 4}, {31, 18, 18, 3}});
  Mesh mesh;
  surface_around(mesh, {12, 12, 12, 10});
  VoxelSet tried;
  const MissedPlaces one = find(mesh, scene, tried);
  CHECK(one.count == std::array<int64_t, 2>{2, 1});
  for (const int threads : {2, 3}) {
    const plc::Schedule schedule(threads);
    VoxelSet marks;
    const MissedPlaces places =
        plc::find_missed_places(mesh, {scene.view(), kIso, true}, {kClearance, kRadius}, schedule,
                                marks, plc::whole_room(scene.view()));
    CHECK(places.count == one.count);
    CHECK(places.low == one.low);
    CHECK(places.high == one.high);
    for (const Missed kind : {Missed::kPart, Missed::kCavity}) {
      CHECK(all_of(places, kind) == all_of(one, kind));
    }
    CHECK(all_of(marks) == all_of(tried));
  }
}

TEST_CASE("parts of fewer than 27 voxels joined by faces are nothing to an adaptive mesh",
          "[missed_places]") {
  for (const bool whole : {true, false}) {
    BallScene scene({kMain});
    for (int32_t z = 10; z < 13; ++z) {
      for (int32_t y = 10; y < 13; ++y) {
        for (int32_t x = 28; x < 31; ++x) scene.at(x, y, z) = 1;
      }
    }
    // Still three by three by three, by an edge.
    if (!whole) scene.at(28, 10, 10) = 0, scene.at(27, 9, 11) = 1;
    Mesh mesh;
    surface_around(mesh, kMain);
    CHECK(find(mesh, scene, {kClearance, 0.6F}).count[kPart] == 1);
    plc::Sizing sizing;
    const plc::Schedule schedule(1);
    REQUIRE(sizing.field.build(scene.view(), kIso, 1, {}, schedule).ok());
    mesh.sizing = &sizing;
    CHECK(find(mesh, scene, {kClearance, 0.6F}).count[kPart] == (whole ? 1 : 0));
  }
}

TEST_CASE("voxels that only touch what is missed are noise where the image is noisy",
          "[missed_places]") {
  BallScene scene({kMain});
  for (int32_t z = 10; z < 13; ++z) {
    for (int32_t y = 10; y < 13; ++y) {
      for (int32_t x = 27; x < 30; ++x) scene.at(x, y, z) = 1;
    }
  }
  scene.at(30, 13, 13) = 1;  // by a corner
  std::vector<float> ramp;
  samples::Random random(2);
  for (int i = 0; i < 16 * 16 * 16; ++i) {
    ramp.push_back(static_cast<float>(0.05 * (i % 16) + random.uniform(-0.5, 0.5)));
  }
  const plc::ImageView noisy{
      ramp.data(), {16, 16, 16}, {1, 1, 1}, {0, 0, 0}, {plc::ImageType::kF32, 0, 0, 0, 1, 4}};
  Mesh mesh;
  surface_around(mesh, kMain);
  for (const bool noise : {false, true}) {
    plc::Sizing sizing;
    REQUIRE(sizing.field.build(noise ? noisy : scene.view(), 0.4F, 1, {}, samples::kSerial).ok());
    REQUIRE((sizing.field.noise() > plc::kNoisy) == noise);
    mesh.sizing = &sizing;
    const MissedPlaces places = find(mesh, scene, {kClearance, 0.6F});
    CHECK(places.count[kPart] == 1);
    CHECK(voxels_of(places, Missed::kPart) == (noise ? 27 : 28));
  }
}
