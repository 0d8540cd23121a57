#include "engine/start/level_start.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <optional>

#include "engine/base/constants.h"
#include "engine/mesh/state_hash.h"
#include "tests/samples/sample_runs.h"

namespace {

using Catch::Matchers::Contains;
using plc::Anisotropy;
using plc::ErrorCode;
using plc::Init;
using plc::Mesh;
using plc::Seed;
using plc::StartSpec;
using samples::Soup;

// 28 x 28 x 14 voxels of 1 x 1 x 2 mm; a ball of 9.8 mm about their middle.
constexpr double kRadius = 9.8;

samples::Run ball_run() {
  return samples::make_run(
      "ball", samples::sphere_potential(samples::empty_volume({28, 28, 14}, {1, 1, 2}), 0.35), 0.5,
      2);
}

double ball_volume(double r) {
  return 4.0 / 3 * 3.14159265358979 * r * r * r;
}

// A start on one level of an image, and what it led to.
struct Started {
  plc::Pyramid pyramid;
  double delta = 0;
  plc::Status status;
  Mesh mesh;
  double cubic_mm = 1;  // of a mesh unit, cubed

  Started(const StartSpec& spec, int h, Anisotropy method = Anisotropy::kVoxel,
          std::optional<float> iso = 0.5F, const samples::Run& run = ball_run(), int threads = 1)
      : pyramid(samples::pyramid_of(run)) {
    const plc::MeshSpace space = plc::mesh_space(pyramid, h, method);
    const plc::LevelImage level{pyramid, h, plc::kPadVoxels, space, iso, run.recovery.inside_above};
    delta =
        pyramid.levels[static_cast<size_t>(h)].unit / pyramid.levels[0].unit / plc::kUnitPerDelta;
    for (size_t a = 0; a < 3; ++a) cubic_mm *= pyramid.levels[0].voxel[a] / space.step[a];
    // Forgotten by the start.
    samples::fill_mesh(mesh, samples::moved(samples::sphere(1), 3, 3, 3), 7);
    const plc::Schedule schedule(threads);
    plc::OperationCounts counts;
    status = plc::start_surface(spec, level, delta, schedule, mesh, counts, {});
  }
  double volume() const { return samples::volume(mesh) * cubic_mm; }
};

// A good start: embedded, and (1), (2) for the level's delta - of a bubble the guards' limits.
void check_sound(const Started& s, bool conformed) {
  REQUIRE(s.status.message() == "");
  REQUIRE(s.mesh.vertex_count() > 0);
  CHECK(s.mesh.delta == s.delta);
  CHECK(plc::broken_invariant(s.mesh) == "");
  CHECK(samples::meeting_count(s.mesh) == 0);
  double shortest = 1e30, longest = 0;
  samples::for_each_edge(s.mesh, [&](uint32_t u, uint32_t k) {
    const auto l =
        static_cast<double>(plc::length(s.mesh.at(u) - s.mesh.at(s.mesh.neighbor(u, k))));
    shortest = std::min(shortest, l / s.delta);
    longest = std::max(longest, l / s.delta);
  });
  CHECK(longest < (conformed ? static_cast<double>(plc::kMaxEdge) : 3.46));
  CHECK(shortest > (conformed ? 1 : 0.5));
}

StartSpec of(Init init) {
  StartSpec spec;
  spec.init = init;
  return spec;
}

// In voxels of the unpadded I_0.
StartSpec of(const Soup& soup) {
  StartSpec spec = of(Init::kMesh);
  spec.xyz.assign(soup.xyz.begin(), soup.xyz.end());
  spec.abc = soup.abc;
  return spec;
}

Soup ball_in_voxels(double radius_mm) {
  Soup ball = samples::sphere(4);
  for (size_t i = 0; i < ball.xyz.size(); ++i) {
    ball.xyz[i] = i % 3 == 2 ? 6.5 + ball.xyz[i] * radius_mm / 2 : 13.5 + ball.xyz[i] * radius_mm;
  }
  return ball;
}

Seed seed(double x, double y, double z, double radius_mm) {
  return {{x, y, z}, {radius_mm, radius_mm, radius_mm / 2}};
}

constexpr Anisotropy kMethods[] = {Anisotropy::kPhysical, Anisotropy::kVoxel, Anisotropy::kMetric};

}  // namespace

TEST_CASE("one bubble goes around the object, in every space and on every level", "[level_start]") {
  for (const Anisotropy method : kMethods) {
    for (const int h : {0, 2}) {
      const Started s(of(Init::kBubble), h, method);
      check_sound(s, false);
      CHECK(samples::component_count(s.mesh) == 1);
      CHECK(s.volume() > ball_volume(kRadius));
      CHECK(s.volume() < 5 * ball_volume(kRadius));
    }
  }
}

TEST_CASE("where no iso tells the object a bubble goes around the whole image", "[level_start]") {
  const Started s(of(Init::kBubble), 1, Anisotropy::kVoxel, std::nullopt);
  check_sound(s, false);
  for (const double x : {-0.4, 27.4}) {
    bool beyond = false;
    for (uint32_t v = 0; v < s.mesh.slots(); ++v) {
      const auto at = static_cast<double>(s.mesh.at(v).x);
      beyond = beyond || (x < 0 ? at < x : at > x);
    }
    CHECK(beyond);
  }
  CHECK(s.volume() > 28.0 * 28 * 28);
}

TEST_CASE("an object that does not show leaves the mesh empty, and is no error", "[level_start]") {
  for (const Init init : {Init::kBubble, Init::kIso}) {
    const Started s(of(init), 1, Anisotropy::kVoxel, 0.999F);
    CHECK(s.status.ok());
    CHECK(s.mesh.vertex_count() == 0);
  }
  StartSpec spec = of(Init::kMask);
  samples::Run run = ball_run();
  run.volume.values.assign(run.volume.values.size(), 0);
  spec.mask = samples::pyramid_of(run);
  const Started s(spec, 1);
  CHECK(s.status.ok());
  CHECK(s.mesh.vertex_count() == 0);
}

TEST_CASE("a grid of bubbles fills the image, or is refused by its numbers", "[level_start]") {
  StartSpec spec = of(Init::kBubbles);
  spec.bubbles = {4, 3, 2};
  for (const Anisotropy method : kMethods) {
    const Started s(spec, 0, method);
    check_sound(s, false);
    CHECK(samples::component_count(s.mesh) == 24);
  }
  spec.bubbles = {20, 3, 2};
  const Started s(spec, 0);
  CHECK(s.status.code() == ErrorCode::kInvalidArgument);
  CHECK_THAT(s.status.message(), Contains("bubbles 20 x 3 x 2"));
}

TEST_CASE("seeds are balls of millimetres in every space", "[level_start]") {
  StartSpec spec = of(Init::kSeeds);
  spec.seeds = {seed(7, 13, 6, 5), seed(20, 13, 6, 6)};
  for (const Anisotropy method : kMethods) {
    const Started s(spec, 0, method);
    check_sound(s, false);
    CHECK(samples::component_count(s.mesh) == 2);
    CHECK(s.volume() == Approx(ball_volume(5) + ball_volume(6)).epsilon(0.2));
    // Around their centres.
    const double step = plc::mesh_space(s.pyramid, 0, method).step[0];
    for (uint32_t v = 0; v < s.mesh.slots(); ++v) {
      const double x = static_cast<double>(s.mesh.at(v).x) / step;
      CHECK(((x > 1.9 && x < 12.1) || (x > 13.9 && x < 26.1)));
    }
  }
}

TEST_CASE("a seed too small for the level is refused with its number, the level and the least",
          "[level_start]") {
  StartSpec spec = of(Init::kSeeds);
  spec.seeds = {seed(7, 13, 6, 7), seed(23, 13.5, 6, 3)};
  CHECK(Started(spec, 0).status.ok());
  const Started s(spec, 2);  // the least radius is 1.15 delta = 2.875 voxels; 1.5 along z
  CHECK(s.status.code() == ErrorCode::kInvalidArgument);
  CHECK(s.status.message() ==
        "seed 1: too small for level 2, where the smallest radius is 5.75 mm; "
        "use fewer levels or larger seeds");
  // In millimetres the same seed is large enough.
  CHECK(Started(spec, 2, Anisotropy::kPhysical).status.ok());
}

TEST_CASE("seeds that are nearer than (3) allows are refused, both named", "[level_start]") {
  StartSpec spec = of(Init::kSeeds);
  spec.seeds = {seed(2, 13, 6, 4), seed(13, 13, 6, 4), seed(22, 13, 6, 4)};
  const Started s(spec, 0);  // the last two are 1 voxel apart: less than 1.25
  CHECK(s.status.code() == ErrorCode::kInvalidArgument);
  CHECK(s.status.message() == "seed 2: touches seed 1 on level 0");
  spec.seeds[2].centre[0] = 22.5;
  check_sound(Started(spec, 0), false);
  // Coarser meshes need more room.
  CHECK_THAT(Started(spec, 1, Anisotropy::kPhysical).status.message(), Contains("on level 1"));
}

TEST_CASE("the iso-surface of the level's image starts near its object", "[level_start]") {
  for (const Anisotropy method : kMethods) {
    for (const int h : {0, 1}) {
      const Started s(of(Init::kIso), h, method);
      check_sound(s, true);
      CHECK(samples::euler(s.mesh) == 2);
      CHECK(s.volume() == Approx(ball_volume(kRadius)).epsilon(h == 0 ? 0.1 : 0.25));
    }
  }
}

TEST_CASE("a dark object's iso-surface is around what is below iso", "[level_start]") {
  samples::Run run = ball_run();
  samples::turn_dark(run);
  const Started s(of(Init::kIso), 0, Anisotropy::kVoxel, 0.5F, run);
  check_sound(s, true);
  CHECK(s.volume() == Approx(ball_volume(kRadius)).epsilon(0.1));
}

TEST_CASE("an iso-surface smaller than the level resolves leaves the mesh empty", "[level_start]") {
  samples::Run run = samples::make_run("spot", samples::empty_volume({20, 20, 20}), 0.5, 0);
  run.volume.values.assign(8000, 0);
  run.volume.values[(10 * 20 + 10) * 20 + 10] = 0.51F;
  const Started s(of(Init::kIso), 0, Anisotropy::kVoxel, 0.5F, run);
  CHECK(s.status.ok());
  CHECK(s.mesh.vertex_count() == 0);
}

TEST_CASE("a mask starts its own surface, whatever the image shows", "[level_start]") {
  StartSpec spec = of(Init::kMask);
  samples::Run run = ball_run();
  run.volume = samples::sampled(run.volume, [](const samples::Point& p) {
    return samples::norm(p[0] - 2, p[1], p[2]) <= 7 ? 1.0 : 0.0;
  });
  spec.mask = samples::pyramid_of(run);
  for (const Anisotropy method : kMethods) {
    const Started s(spec, 0, method, std::nullopt);
    check_sound(s, true);
    CHECK(samples::euler(s.mesh) == 2);
    CHECK(s.volume() == Approx(ball_volume(7)).epsilon(0.15));
  }
  check_sound(Started(spec, 1), true);
}

TEST_CASE("a given mesh starts at the level's density, in every space", "[level_start]") {
  for (const Anisotropy method : kMethods) {
    for (const int h : {0, 2}) {
      const Started s(of(ball_in_voxels(9)), h, method);
      check_sound(s, true);
      CHECK(samples::euler(s.mesh) == 2);
      CHECK(s.volume() == Approx(ball_volume(9)).epsilon(h == 0 ? 0.06 : 0.25));
    }
  }
}

TEST_CASE("a mesh that is no closed embedded surface is refused, and says why", "[level_start]") {
  Soup open = ball_in_voxels(9);
  open.abc.resize(open.abc.size() - 3);
  const Started torn(of(open), 0);
  CHECK(torn.status.code() == ErrorCode::kInvalidData);
  CHECK_THAT(torn.status.message(), Contains("open") || Contains("border"));
  CHECK(torn.mesh.vertex_count() == 0);
  const Started inverted(of(samples::flipped(ball_in_voxels(9))), 0);
  CHECK(inverted.status.code() == ErrorCode::kInvalidData);
  CHECK_THAT(inverted.status.message(), Contains("turned outward"));
}

TEST_CASE("a mesh that reaches far beyond the image is refused, and says where", "[level_start]") {
  for (const double far : {1e5, -1e5}) {
    Soup ball = ball_in_voxels(9);
    ball.xyz[3 * 7 + 1] = static_cast<float>(far);
    const Started s(of(ball), 0);
    CHECK(s.status.code() == ErrorCode::kInvalidArgument);
    CHECK(s.status.message() == "vertex 7 of the mesh lies too far beyond the image");
  }
}

TEST_CASE("a given mesh of which nothing is left on the level is an error", "[level_start]") {
  const Started s(of(ball_in_voxels(0.8)), 2);
  CHECK(s.status.code() == ErrorCode::kInvalidData);
  CHECK_THAT(s.status.message(), Contains("nothing is left"));
}

TEST_CASE("a start has the same bits for any number of threads", "[level_start]") {
  StartSpec seeds = of(Init::kSeeds);
  seeds.seeds = {seed(7, 13, 6, 5), seed(20, 13, 6, 6)};
  StartSpec bubbles = of(Init::kBubbles);
  bubbles.bubbles = {4, 3, 2};
  StartSpec mask = of(Init::kMask);
  const samples::Run ball = ball_run();
  mask.mask = samples::pyramid_of(ball);
  const StartSpec iso = of(Init::kIso), bubble = of(Init::kBubble), mesh = of(ball_in_voxels(9));
  for (const StartSpec* spec :
       std::initializer_list<const StartSpec*>{&seeds, &bubbles, &mask, &iso, &bubble, &mesh}) {
    const Started one(*spec, 0);
    for (const int threads : {2, 3}) {
      const Started more(*spec, 0, Anisotropy::kVoxel, 0.5, ball_run(), threads);
      CHECK(plc::state_hash(more.mesh) == plc::state_hash(one.mesh));
    }
  }
}
