// The C API: faces that the surface may neither meet nor pass over.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/samples/sample_api.h"
#include "tests/samples/sample_meshes.h"
#include "tests/samples/sample_steps.h"

namespace {

using Catch::Matchers::Contains;
using samples::Context;
using samples::Soup;
using samples::Surface;

constexpr double kMiddle = 13.5;  // of the image, mm

// A ball of radius 10, and the start within it.
struct Walled {
  samples::Volume volume =
      samples::sampled(samples::empty_volume({28, 28, 28}, {1, 1, 1}), [](const auto& p) {
        return std::clamp(0.5 + 10 - samples::norm(p[0], p[1], p[2]), 0.0, 1.0);
      });
  plc_image image = samples::image_of(volume);
  plc_parameters parameters = samples::parameters(0.5, 0);
  plc_seed seed{{kMiddle - 4, kMiddle, kMiddle}, 3};
  Soup obstacles;
  double gap = 0;

  Walled() {
    parameters.init = PLC_INIT_SEEDS;
    parameters.late_bubbles = 0;
  }
  plc_extras extras() const {
    plc_extras e = samples::no_extras();
    e.seeds = &seed;
    e.seed_count = 1;
    e.obstacle_xyz = obstacles.xyz.data();
    e.obstacle_vertex_count = static_cast<int64_t>(obstacles.vertex_count());
    e.obstacle_abc = obstacles.abc.data();
    e.obstacle_face_count = static_cast<int64_t>(obstacles.face_count());
    e.obstacle_gap = gap;
    return e;
  }
};

// A square across x, which the surface cannot go around.
void add_wall(Soup& m, double x) {
  const auto corner = [&](double y, double z) { return m.vertex(x, kMiddle + y, kMiddle + z); };
  const std::array<uint32_t, 4> c = {corner(-16, -16), corner(16, -16), corner(16, 16),
                                     corner(-16, 16)};
  m.face(c[0], c[1], c[2]);
  m.face(c[0], c[2], c[3]);
}

Soup soup_of(const plc_surface* surface) {
  Soup m;
  m.xyz = samples::positions_f64(surface, PLC_SPACE_LPS);
  const std::vector<uint32_t> abc = samples::faces(surface, PLC_SPACE_LPS);
  m.abc.assign(abc.begin(), abc.end());
  return m;
}

plc_check checked(plc_context* context, const Soup& m) {
  plc_check check;
  check.struct_size = sizeof check;
  REQUIRE(plc_check_mesh(context, m.xyz.data(), static_cast<int64_t>(m.vertex_count()),
                         m.abc.data(), static_cast<int64_t>(m.face_count()), &check) == PLC_OK);
  return check;
}

double highest_x(const Soup& m) {
  double x = m.xyz[0];
  for (size_t i = 0; i < m.xyz.size(); i += 3) x = std::max(x, m.xyz[i]);
  return x;
}

std::string refusal(const Walled& scene, plc_status expected = PLC_INVALID_ARGUMENT) {
  const Context context = samples::make_context();
  const plc_extras extras = scene.extras();
  plc_surface* surface = nullptr;
  CHECK(plc_extract(context.get(), &scene.image, &scene.parameters, &extras, &surface) == expected);
  CHECK(surface == nullptr);
  return plc_context_message(context.get());
}

}  // namespace

TEST_CASE("a surface stops at a wall, as near as the gap lets it", "[pellicle_obstacles]") {
  constexpr double kWall = kMiddle + 4.25;
  for (const double gap : {0.0, 0.1}) {
    CAPTURE(gap);
    Walled scene;
    add_wall(scene.obstacles, kWall);
    scene.gap = gap;
    const plc_extras extras = scene.extras();
    const Context context = samples::make_context();
    const Surface made = samples::extract(context.get(), scene.image, scene.parameters, &extras);
    CHECK(samples::level_of(made.get(), 0).converged == 1);
    Soup m = soup_of(made.get());
    CHECK(checked(context.get(), m).valid == 1);
    const double delta = samples::level_of(made.get(), 0).delta;
    const double room = kWall - highest_x(m);
    CHECK(room > 0.99 * gap * delta);
    CHECK(room < 0.3 + gap * delta);  // it comes up to the wall ...
    m.append(scene.obstacles);
    CHECK(checked(context.get(), m).self_intersections == 0);
    double lowest = kMiddle;
    for (size_t i = 0; i < m.xyz.size(); i += 3) lowest = std::min(lowest, m.xyz[i]);
    CHECK(lowest == Approx(kMiddle - 10).margin(0.3));  // ... and elsewhere to the ball
  }
}

TEST_CASE("a surface does not pass over an obstacle that is smaller than its faces",
          "[pellicle_obstacles]") {
  Walled scene;
  for (const double y : {-6.3, 0.2, 5.9}) {
    scene.obstacles.append(
        samples::moved(samples::octahedron(), kMiddle + 3.1, kMiddle + y, kMiddle + 0.37, 0.15));
  }
  const plc_extras extras = scene.extras();
  const Context context = samples::make_context();
  Soup m = soup_of(samples::extract(context.get(), scene.image, scene.parameters, &extras).get());
  CHECK(highest_x(m) > kMiddle + 9.5);  // it goes on beside them
  m.append(scene.obstacles);
  const plc_check all = checked(context.get(), m);
  CAPTURE(all.self_intersections, all.wrongly_oriented_components, all.closed,
          all.degenerate_faces);
  CHECK(all.valid == 1);  // none lies inside
}

TEST_CASE("with obstacles results do not depend on threads, targets or interruptions",
          "[pellicle_obstacles]") {
  Walled scene;
  add_wall(scene.obstacles, kMiddle + 3.3);
  scene.gap = 0.05;
  const plc_extras extras = scene.extras();
  const Context one = samples::make_context(1), other = samples::make_context(3, PLC_SIMD_SCALAR);
  const uint64_t hash =
      plc_surface_hash(samples::extract(one.get(), scene.image, scene.parameters, &extras).get());
  CHECK(hash == plc_surface_hash(
                    samples::extract(other.get(), scene.image, scene.parameters, &extras).get()));
  const auto pyramid = samples::pyramid_of(one.get(), scene.image, scene.parameters);
  const auto run = samples::run_of(one.get(), pyramid.get(), scene.parameters, &extras);
  for (int i = 0; i < 12; ++i) samples::advance(one.get(), run.get(), PLC_ONE_ITERATION);
  const auto state = samples::saved(one.get(), run.get());
  samples::RunHandle resumed;
  REQUIRE(samples::restore(one.get(), pyramid.get(), scene.parameters, state, resumed, &extras) ==
          PLC_OK);
  while (samples::advance(one.get(), resumed.get(), PLC_ONE_LEVEL).done == 0) {
  }
  CHECK(samples::hash_now(one.get(), resumed.get()) == hash);
  // The obstacles belong to the run.
  Walled bare;
  const plc_extras none = bare.extras();
  CHECK(samples::restore(one.get(), pyramid.get(), scene.parameters, state, resumed, &none) ==
        PLC_INVALID_DATA);
}

TEST_CASE("obstacles that cannot be are refused by name", "[pellicle_obstacles]") {
  const auto with = [](const std::function<void(Walled&)>& change,
                       plc_status expected = PLC_INVALID_ARGUMENT) {
    Walled scene;
    add_wall(scene.obstacles, kMiddle + 4);
    change(scene);
    return refusal(scene, expected);
  };
  CHECK_THAT(with([](Walled& s) { s.gap = 1.5; }),
             Contains("obstacle gap 1.5 is not within 0 .. 1"));
  CHECK_THAT(with([](Walled& s) { s.gap = NAN; }), Contains("obstacle gap"));
  CHECK_THAT(with([](Walled& s) { s.parameters.levels = 1; }), Contains("levels and late_bubbles"));
  CHECK_THAT(with([](Walled& s) { s.parameters.late_bubbles = 1; }), Contains("late_bubbles"));
  CHECK_THAT(with([](Walled& s) { s.obstacles.abc[4] = 4; }),
             Contains("face 1 refers to vertex 4 of 4"));
  CHECK_THAT(with([](Walled& s) { s.obstacles.abc[1] = 2; }), Contains("face 0 has no area"));
  CHECK_THAT(with([](Walled& s) { s.obstacles.xyz[5] = INFINITY; }),
             Contains("vertex 1 lies at inf"));
  CHECK_THAT(with([](Walled& s) { s.seed.centre[0] = kMiddle + 3; }, PLC_INVALID_DATA),
             Contains("meets the surface to start from"));
}
