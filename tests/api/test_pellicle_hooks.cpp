// The C API: verdicts, attachments and pins of the user, features and late bubbles.
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <string>

#include "tests/samples/sample_hosts.h"

using namespace samples;
using Catch::Matchers::Contains;

TEST_CASE("the level callback may ask its surface for anything, and stop there", "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball({28, 28, 18}, {1, 1, 1.5});
  const plc_image image = image_of(volume);
  for (const plc_anisotropy method :
       {PLC_ANISOTROPY_PHYSICAL, PLC_ANISOTROPY_VOXEL, PLC_ANISOTROPY_METRIC}) {
    for (const int last : {1, 0}) {
      std::vector<int> levels;
      std::vector<float> seen;
      uint64_t hash = 0;
      Host host;
      host.level = [&](const plc_level_report& report, const plc_surface* surface) {
        levels.push_back(report.level);
        CHECK(report.struct_size == sizeof report);
        CHECK(report.converged == 1);
        CHECK(report.vertices == plc_surface_vertex_count(surface));
        CHECK(plc_surface_level_count(surface) == static_cast<int>(levels.size()));
        const plc_measures m = measured(context.get(), surface, PLC_SPACE_LPS);
        CHECK(m.volume == Approx(ball_volume(kRadius)).epsilon(0.25));
        CHECK(m.genus == 0);
        seen = positions(surface, PLC_SPACE_LPS);
        hash = plc_surface_hash(surface);
        return report.level == last ? PLC_VERDICT_STOP : PLC_VERDICT_ACCEPT;
      };
      const plc_extras extras = extras_of(host);
      plc_parameters p = gentle(1);
      p.anisotropy = method;
      const Surface surface = extract(context.get(), image, p, &extras);
      CHECK(levels == (last == 1 ? std::vector<int>{1} : std::vector<int>{1, 0}));
      CHECK(plc_surface_level_count(surface.get()) == 2 - last);
      CHECK(positions(surface.get(), PLC_SPACE_LPS) == seen);
      CHECK(plc_surface_hash(surface.get()) == hash);
    }
  }
}

TEST_CASE("a verdict of more runs the level on", "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball();
  const plc_image image = image_of(volume);
  std::vector<int64_t> iterations;
  Host host;
  host.level = [&](const plc_level_report& report, const plc_surface*) {
    iterations.push_back(report.iterations);
    return iterations.size() < 3 ? PLC_VERDICT_MORE : PLC_VERDICT_ACCEPT;
  };
  const plc_extras extras = extras_of(host);
  plc_parameters p = gentle(1);
  p.max_iterations = 5;
  const Surface surface = extract(context.get(), image, p, &extras);
  CHECK(iterations == std::vector<int64_t>{5, 10, 15, 5});
  CHECK(level_of(surface.get(), 0).iterations == 15);
}

TEST_CASE("an internal error tells its cause in one line", "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball();
  const plc_image image = image_of(volume);
  const plc_parameters p = gentle();
  const auto message_of = [&](plc_progress_fn progress) {
    plc_extras extras = no_extras();
    extras.progress = progress;
    plc_surface* surface = nullptr;
    CHECK(plc_extract(context.get(), &image, &p, &extras, &surface) == PLC_INTERNAL);
    CHECK(surface == nullptr);
    return std::string(plc_context_message(context.get()));
  };
  // No callback may throw; it stands for what the engine itself would throw by mistake.
  CHECK(message_of([](const plc_progress*, void*) -> int {
          throw std::logic_error("ring 7\nhas no end");
        }) == "internal error: ring 7 has no end");
  CHECK(message_of([](const plc_progress*, void*) -> int { throw 7; }) ==
        "internal error: something was thrown that is no std::exception");
}

TEST_CASE("an internal error of another thread tells its cause", "[pellicle]") {
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.parallel_for = [](size_t, plc_task_fn, void*, void*) {
    throw std::logic_error("no such thread");
  };
  plc_context* made = nullptr;
  REQUIRE(plc_context_create(&options, &made, nullptr, 0) == PLC_OK);
  const Context context(made);
  const Volume volume = ball();
  const plc_image image = image_of(volume);
  const plc_parameters p = gentle();
  plc_surface* surface = nullptr;
  CHECK(plc_extract(context.get(), &image, &p, nullptr, &surface) == PLC_INTERNAL);
  CHECK(std::string(plc_context_message(context.get())) == "internal error: no such thread");
}

TEST_CASE("an attachment pulls the surface through its place, and only there", "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball();
  const plc_image image = image_of(volume);
  const Point outside{kRadius + 2.5, 0, 0};
  const Point at = in_image(image, outside);
  for (const plc_space space : {PLC_SPACE_LPS, PLC_SPACE_RAS}) {
    const double sign = space == PLC_SPACE_RAS ? -1 : 1;
    const plc_attachment attachment{{sign * at[0], sign * at[1], at[2]}, 5, 4};
    plc_extras extras = no_extras();
    extras.space = space;
    extras.attachments = &attachment;
    extras.attachment_count = 1;
    const Surface plain = extract(context.get(), image, gentle());
    const Surface pulled = extract(context.get(), image, gentle(), &extras);
    CHECK(distance_to(about_middle(plain.get(), image), outside) > 2);
    CHECK(distance_to(about_middle(pulled.get(), image), outside) < 0.9);  // an edge is 1.3
    CHECK(level_of(pulled.get(), 0).converged == 1);
    double opposite = 0;
    for (const Point& p : about_middle(pulled.get(), image)) {
      if (p[0] < 0) opposite = std::max(opposite, std::abs(norm(p[0], p[1], p[2]) - kRadius));
    }
    CHECK(opposite < 0.5);
    CHECK(measured(context.get(), pulled.get(), PLC_SPACE_LPS).components == 1);
  }
}

TEST_CASE("the strongest attachments there can be leave the surface valid", "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball();
  const plc_image image = image_of(volume);
  const Point at = in_image(image, {kRadius + 2.5, 0, 0});
  for (const double strength : {1e3, 1e6}) {
    const plc_attachment attachment{{at[0], at[1], at[2]}, 6, strength};
    plc_extras extras = no_extras();
    extras.attachments = &attachment;
    extras.attachment_count = 1;
    plc_parameters p = gentle();
    p.max_iterations = 100;
    const Surface surface = extract(context.get(), image, p, &extras);
    std::vector<double> xyz;
    for (const float x : positions(surface.get(), PLC_SPACE_LPS)) {
      xyz.push_back(static_cast<double>(x));
    }
    const auto abc = faces(surface.get(), PLC_SPACE_LPS);
    plc_check check{};
    check.struct_size = sizeof check;
    REQUIRE(plc_check_mesh(context.get(), xyz.data(), static_cast<int64_t>(xyz.size() / 3),
                           abc.data(), static_cast<int64_t>(abc.size() / 3), &check) == PLC_OK);
    CHECK(check.valid == 1);
  }
}

TEST_CASE("a pin keeps the start where it is while the rest goes to the object", "[pellicle]") {
  const Context context = make_context();
  const Volume volume = ball();
  const plc_image image = image_of(volume);
  const Point centre = in_image(image, {0, 0, 0});
  const Point place = in_image(image, {11, 0, 0});
  const plc_seed seed{{centre[0], centre[1], centre[2]}, 11};
  const plc_pin pin{{place[0], place[1], place[2]}, 2.5};
  plc_extras extras = no_extras();
  extras.seeds = &seed;
  extras.seed_count = 1;
  plc_parameters p = gentle();
  p.init = PLC_INIT_SEEDS;
  const Surface plain = extract(context.get(), image, p, &extras);
  CHECK(distance_to(about_middle(plain.get(), image), {11, 0, 0}) > 2.5);
  extras.pins = &pin;
  extras.pin_count = 1;
  const Surface pinned = extract(context.get(), image, p, &extras);
  CHECK(distance_to(about_middle(pinned.get(), image), {11, 0, 0}) < pin.radius);
  CHECK(distance_to(about_middle(pinned.get(), image), {-11, 0, 0}) > 2.5);
}

TEST_CASE("the norm of the gradient as feature shows the object's contour, inside and out",
          "[pellicle]") {
  // The values change from 1 to 0 within 2 mm of the contour: 1/4 per mm.
  const Volume volume = sampled(empty_volume({30, 30, 30}), [](const Point& p) {
    return std::clamp(0.5 + 0.25 * (kRadius - norm(p[0], p[1], p[2])), 0.0, 1.0);
  });
  const Context context = make_context();
  const plc_image image = image_of(volume);
  plc_parameters p = parameters(0.125, 0);
  p.feature = PLC_FEATURE_GRADIENT_NORM;
  p.init = PLC_INIT_BUBBLE;
  const Surface surface = extract(context.get(), image, p);
  CHECK(samples::range_of(surface.get())[0] == Approx(0).margin(1e-6));
  CHECK(samples::range_of(surface.get())[1] == Approx(0.25).epsilon(0.02));
  const plc_measures m = measured(context.get(), surface.get(), PLC_SPACE_LPS);
  CHECK(m.components == 2);
  CHECK(m.volume == Approx(ball_volume(kRadius + 2) - ball_volume(kRadius - 2)).epsilon(0.1));
  // The inner wall is a cavity that the bubble has passed by.
  CHECK(level_of(surface.get(), 0).late_cavities == 1);
  CHECK(level_of(surface.get(), 0).late_bubbles == 0);
  CHECK(level_of(surface.get(), 0).late_volume == Approx(ball_volume(kRadius - 2)).epsilon(0.3));
  // A Gaussian makes the ramp wider and its top lower.
  p.feature_sigma = 2;
  p.iso = 0.1;
  const Surface smooth = extract(context.get(), image, p);
  CHECK(samples::range_of(smooth.get())[1] < 0.2);
  p.feature_sigma = -1;
  plc_surface* none = nullptr;
  CHECK(plc_extract(context.get(), &image, &p, nullptr, &none) == PLC_INVALID_ARGUMENT);
  CHECK_THAT(plc_context_message(context.get()), Contains("feature sigma"));
}

TEST_CASE("late bubbles are told in the report and can be turned off", "[pellicle]") {
  const Volume volume = sampled(empty_volume({44, 24, 24}), [](const Point& p) {
    const double depth = std::max(8 - norm(p[0] - 9, p[1], p[2]), 4 - norm(p[0] + 15, p[1], p[2]));
    return std::clamp(0.5 + 0.25 * depth, 0.0, 1.0);
  });
  const Context context = make_context();
  const plc_image image = image_of(volume);
  const Point centre = in_image(image, {9, 0, 0});
  const plc_seed seed{{centre[0], centre[1], centre[2]}, 9};
  plc_extras extras = no_extras();
  extras.seeds = &seed;
  extras.seed_count = 1;
  plc_parameters p = gentle();
  p.init = PLC_INIT_SEEDS;
  const Surface both = extract(context.get(), image, p, &extras);
  CHECK(measured(context.get(), both.get(), PLC_SPACE_LPS).components == 2);
  const plc_level_report report = level_of(both.get(), 0);
  CHECK(report.late_bubbles == 1);
  CHECK(report.late_cavities == 0);
  CHECK(report.late_volume == Approx(ball_volume(4)).epsilon(0.15));
  p.late_bubbles = 0;
  const Surface one = extract(context.get(), image, p, &extras);
  CHECK(measured(context.get(), one.get(), PLC_SPACE_LPS).components == 1);
  CHECK(level_of(one.get(), 0).late_bubbles == 0);
  CHECK(level_of(one.get(), 0).late_volume == 0);
}

TEST_CASE("a bright shell is found by its gradient alone, without an iso-value", "[pellicle]") {
  const Volume volume = shell(empty_volume({40, 40, 40}));
  const Context context = make_context();
  const plc_image image = image_of(volume);
  const Point centre = in_image(image, {0, 0, 0});
  const plc_seed seed{{centre[0], centre[1], centre[2]}, 19};
  plc_extras extras = no_extras();
  extras.seeds = &seed;
  extras.seed_count = 1;
  plc_parameters p = parameters(std::nan(""), 0);
  p.init = PLC_INIT_SEEDS;
  p.force = PLC_FORCE_GRADIENT;
  p.gradient = 0.1;  // figure 22
  p.spring = 0.2;
  p.rest_length = PLC_REST_ZERO;
  p.curvature = 1.5;
  const Surface surface = extract(context.get(), image, p, &extras);
  const plc_measures m = measured(context.get(), surface.get(), PLC_SPACE_LPS);
  CHECK(m.components == 1);
  CHECK(m.volume == Approx(ball_volume(0.36 * 40)).epsilon(0.12));
  const plc_level_report report = level_of(surface.get(), 0);
  CHECK(report.converged == 1);
  CHECK(std::isnan(report.iso));
  CHECK(report.late_bubbles + report.late_cavities == 0);
  const plc_parameters used = samples::parameters_of(surface.get());
  CHECK(used.level_iso_count == 0);
  // The other forces need one.
  p.force = PLC_FORCE_BOTH;
  plc_surface* none = nullptr;
  CHECK(plc_extract(context.get(), &image, &p, &extras, &none) == PLC_INVALID_ARGUMENT);
  CHECK(std::string(plc_context_message(context.get())) == "iso: not set");
}

TEST_CASE("everything together has the same bits for 1, 2 and 3 threads", "[pellicle]") {
  const Volume volume = blobs(empty_volume({54, 52, 46}, {1, 1, 1.3}), 20, 3);
  const plc_image image = image_of(volume);
  const plc_attachment attachment{{30, 20, 20}, 8, 3};
  const plc_pin pin{{10, 10, 10}, 4};
  std::vector<uint64_t> hashes;
  std::vector<int64_t> late;
  for (const int threads : {1, 2, 3}) {
    const Context context = make_context(threads);
    Host host;
    host.force = [](const plc_force_points& points, float* forces) {
      for (int64_t i = 0; i < 3 * points.count; i += 3) {
        forces[i] = 0.03F * points.normals[i];
        forces[i + 2] = -0.01F;
      }
      return 0;
    };
    plc_extras extras = extras_of(host);
    extras.attachments = &attachment;
    extras.attachment_count = 1;
    extras.pins = &pin;
    extras.pin_count = 1;
    plc_parameters p = parameters(0.35, 1);
    p.force = PLC_FORCE_BOTH;
    p.gradient = 0.1;
    p.gradient_tangent = 0.05;
    p.anisotropy = PLC_ANISOTROPY_METRIC;
    p.max_iterations = 30;
    const Surface surface = extract(context.get(), image, p, &extras);
    hashes.push_back(plc_surface_hash(surface.get()));
    late.push_back(level_of(surface.get(), 1).late_bubbles);
    CHECK(plc_surface_vertex_count(surface.get()) > 4096);  // the parallel paths
  }
  for (const size_t i : {1U, 2U}) {
    CHECK(hashes[i] == hashes[0]);
    CHECK(late[i] == late[0]);
  }
}
