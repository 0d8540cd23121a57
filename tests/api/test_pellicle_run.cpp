// Volumes, pyramids and runs of the C API: the extraction in steps of any size.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"
#include "tests/samples/sample_hosts.h"
#include "tests/samples/sample_steps.h"

using namespace samples;
using Catch::Matchers::Contains;
using Pyramid = PyramidHandle;
using Run = RunHandle;

TEST_CASE("a run in iterations, in levels and at once is the extraction", "[pellicle_run]") {
  const Scene s;
  const Context context = make_context(2);
  const uint64_t whole = plc_surface_hash(extract(context.get(), s.image, s.parameters).get());
  const Pyramid pyramid = pyramid_of(context.get(), s.image, s.parameters);
  for (const plc_amount amount : {PLC_ONE_ITERATION, PLC_ONE_LEVEL, PLC_ALL_LEVELS}) {
    const Run run = run_of(context.get(), pyramid.get(), s.parameters);
    int calls = 0;
    plc_run_state state{};
    while (state.done == 0) {
      state = advance(context.get(), run.get(), amount);
      ++calls;
      if (amount == PLC_ONE_LEVEL) CHECK(state.between_levels == 1);
    }
    const Surface surface = surface_of(context.get(), run.get());
    CHECK(plc_surface_hash(surface.get()) == whole);
    int64_t iterations = 0;
    for (int i = 0; i < plc_surface_level_count(surface.get()); ++i) {
      iterations += level_of(surface.get(), i).iterations;
    }
    const int64_t expected = amount == PLC_ALL_LEVELS  ? 1
                             : amount == PLC_ONE_LEVEL ? 3
                                                       : iterations;
    CHECK(calls == expected);
    CHECK(state.progress.level == 0);
    CHECK(state.progress.fraction > 0.9);
    // Done is done.
    CHECK(advance(context.get(), run.get(), amount).done == 1);
    CHECK(hash_now(context.get(), run.get()) == whole);
  }
}

TEST_CASE("the surface of a run is valid from the start on and after every iteration",
          "[pellicle_run]") {
  const Scene s;
  const Context context = make_context();
  const Pyramid pyramid = pyramid_of(context.get(), s.image, s.parameters);
  const Run run = run_of(context.get(), pyramid.get(), s.parameters);
  CHECK(plc_surface_vertex_count(surface_of(context.get(), run.get()).get()) > 0);
  plc_run_state state{};
  while (state.done == 0) {
    const Surface surface = surface_of(context.get(), run.get());
    plc_check check{};
    check.struct_size = sizeof check;
    REQUIRE(plc_surface_check(context.get(), surface.get(), &check) == PLC_OK);
    REQUIRE(check.valid == 1);
    state = advance(context.get(), run.get(), PLC_ONE_ITERATION);
  }
}

TEST_CASE("a run that was cancelled goes on as if nothing had been", "[pellicle_run]") {
  const Scene s;
  const Context context = make_context();
  const uint64_t whole = plc_surface_hash(extract(context.get(), s.image, s.parameters).get());
  struct Stop {
    int calls = 0, every = 0;
  } stop{0, 13};
  plc_extras extras = no_extras();
  extras.progress = [](const plc_progress*, void* user) {
    auto& told = *static_cast<Stop*>(user);
    return ++told.calls % told.every == 0 ? 1 : 0;
  };
  extras.progress_user = &stop;
  const Pyramid pyramid = pyramid_of(context.get(), s.image, s.parameters);
  const Run run = run_of(context.get(), pyramid.get(), s.parameters, &extras);
  int cancelled = 0;
  plc_status status = PLC_CANCELLED;
  while (status == PLC_CANCELLED) {
    status = plc_run_advance(context.get(), run.get(), PLC_ALL_LEVELS, nullptr);
    cancelled += status == PLC_CANCELLED ? 1 : 0;
  }
  CHECK(status == PLC_OK);
  CHECK(cancelled == stop.calls / stop.every);
  CHECK(cancelled > 3);
  CHECK(hash_now(context.get(), run.get()) == whole);
}

TEST_CASE("a force that cancels, in any of the four calls, leaves the iteration undone",
          "[pellicle_run]") {
  const Volume volume = ball({24, 24, 24});
  const plc_image image = image_of(volume);
  const plc_parameters p = gentle();
  const Context context = make_context();
  const Pyramid pyramid = pyramid_of(context.get(), image, p);
  int calls = 0, refuse = 0;
  Host host;
  host.force = [&](const plc_force_points& points, float* forces) {
    for (int64_t i = 0; i < 3 * points.count; ++i) forces[i] = 0.02F * points.normals[i];
    return ++calls == refuse ? 1 : 0;
  };
  plc_extras extras = extras_of(host);
  const Run undisturbed = run_of(context.get(), pyramid.get(), p, &extras);
  const Run run = run_of(context.get(), pyramid.get(), p, &extras);
  for (int i = 0; i < 12; ++i) {
    advance(context.get(), undisturbed.get(), PLC_ONE_ITERATION);
    const uint64_t before = hash_now(context.get(), run.get());
    calls = 0;
    refuse = 1 + i % 4;
    CHECK(plc_run_advance(context.get(), run.get(), PLC_ONE_ITERATION, nullptr) == PLC_CANCELLED);
    CHECK(hash_now(context.get(), run.get()) == before);
    refuse = 0;
    advance(context.get(), run.get(), PLC_ONE_ITERATION);
    CHECK(hash_now(context.get(), run.get()) == hash_now(context.get(), undisturbed.get()));
  }
}

TEST_CASE("a verdict may cancel, and is asked for again", "[pellicle_run]") {
  const Scene s;
  const Context context = make_context();
  const uint64_t whole = plc_surface_hash(extract(context.get(), s.image, s.parameters).get());
  const Pyramid pyramid = pyramid_of(context.get(), s.image, s.parameters);
  int asked = 0;
  Host host;
  host.level = [&](const plc_level_report&, const plc_surface*) {
    return ++asked % 3 == 0 ? PLC_VERDICT_ACCEPT : PLC_VERDICT_CANCEL;
  };
  const plc_extras extras = extras_of(host);
  const Run run = run_of(context.get(), pyramid.get(), s.parameters, &extras);
  plc_run_state state{};
  state.struct_size = sizeof state;
  int cancelled = 0;
  while (plc_run_advance(context.get(), run.get(), PLC_ALL_LEVELS, nullptr) == PLC_CANCELLED) {
    ++cancelled;
    REQUIRE(plc_run_get_state(context.get(), run.get(), &state) == PLC_OK);
    CHECK(state.done == 0);
    // Saved before the answer, the question comes again.
    Run restored;
    REQUIRE(restore(context.get(), pyramid.get(), s.parameters, saved(context.get(), run.get()),
                    restored, &extras) == PLC_OK);
    plc_run_state there = state;
    REQUIRE(plc_run_get_state(context.get(), restored.get(), &there) == PLC_OK);
    CHECK(there.progress.energy == state.progress.energy);
    CHECK(there.progress.level == state.progress.level);
  }
  CHECK(cancelled == 6);
  CHECK(asked == 9);
  REQUIRE(plc_run_get_state(context.get(), run.get(), &state) == PLC_OK);
  CHECK(state.done == 1);
  CHECK(hash_now(context.get(), run.get()) == whole);
}

TEST_CASE("a run that has failed has ended, and says so", "[pellicle_run]") {
  const Volume volume = ball({24, 24, 24});
  const plc_image image = image_of(volume);
  const plc_parameters p = gentle();
  const Context context = make_context();
  const Pyramid pyramid = pyramid_of(context.get(), image, p);
  Host host;
  host.force = [](const plc_force_points&, float* forces) {
    forces[0] = NAN;
    return 0;
  };
  const plc_extras extras = extras_of(host);
  const Run run = run_of(context.get(), pyramid.get(), p, &extras);
  CHECK(plc_run_advance(context.get(), run.get(), PLC_ALL_LEVELS, nullptr) == PLC_INVALID_ARGUMENT);
  CHECK_THAT(plc_context_message(context.get()), Contains("not finite"));
  CHECK(plc_run_advance(context.get(), run.get(), PLC_ALL_LEVELS, nullptr) == PLC_INVALID_ARGUMENT);
  CHECK_THAT(plc_context_message(context.get()), Contains("ended by an error"));
  plc_surface* surface = nullptr;
  CHECK(plc_run_surface(context.get(), run.get(), &surface) == PLC_INVALID_ARGUMENT);
  size_t size = 0;
  CHECK(plc_run_save(context.get(), run.get(), nullptr, 0, &size) == PLC_INVALID_ARGUMENT);
}

TEST_CASE("a run cannot be used from within its own callbacks", "[pellicle_run]") {
  const Scene s;
  const Context context = make_context(), other = make_context();
  const Pyramid pyramid = pyramid_of(context.get(), s.image, s.parameters);
  struct Inner {
    plc_context* context;
    plc_run* run = nullptr;
    plc_status status = PLC_OK;
  } inner{other.get()};
  plc_extras extras = no_extras();
  extras.progress = [](const plc_progress*, void* user) {
    auto& i = *static_cast<Inner*>(user);
    i.status = plc_run_advance(i.context, i.run, PLC_ONE_ITERATION, nullptr);
    return 0;
  };
  extras.progress_user = &inner;
  const Run run = run_of(context.get(), pyramid.get(), s.parameters, &extras);
  inner.run = run.get();
  advance(context.get(), run.get(), PLC_ONE_ITERATION);
  CHECK(inner.status == PLC_INVALID_ARGUMENT);
  CHECK_THAT(plc_context_message(other.get()), Contains("middle of a call"));
}

TEST_CASE("handles go in any order", "[pellicle_run]") {
  const Scene s;
  Context context = make_context();
  VolumeHandle volume = volume_of(context.get(), s.image, PLC_COPY);
  plc_pyramid* made = nullptr;
  REQUIRE(plc_pyramid_create(context.get(), volume.get(), &s.parameters, &made) == PLC_OK);
  Pyramid pyramid(made);
  volume.reset();
  Run run = run_of(context.get(), pyramid.get(), s.parameters);
  pyramid.reset();
  Surface surface = surface_of(context.get(), run.get());
  context.reset();
  Context other = make_context();
  // What the first context made is still of use with another one, and nothing of it is in the
  // other's memory, which may go first.
  CHECK(advance(other.get(), run.get(), PLC_ONE_LEVEL).between_levels == 1);
  surface = surface_of(other.get(), run.get());
  saved(other.get(), run.get());
  int64_t now = -1;
  REQUIRE(plc_context_memory(other.get(), &now, nullptr) == PLC_OK);
  CHECK(now == 0);
  other.reset();
  const Context third = make_context();
  CHECK(advance(third.get(), run.get(), PLC_ONE_LEVEL).between_levels == 1);
  run.reset();
  CHECK(plc_surface_vertex_count(surface.get()) > 0);
  CHECK(positions(surface.get(), PLC_SPACE_LPS).size() > 0);
}

TEST_CASE("one pyramid serves several runs, with other coefficients", "[pellicle_run]") {
  const Scene s;
  const Context context = make_context();
  const Pyramid pyramid = pyramid_of(context.get(), s.image, s.parameters);
  plc_parameters softer = s.parameters;
  softer.curvature = 0.3;
  plc_parameters derived;
  plc_parameters_defaults(&derived);
  REQUIRE(plc_pyramid_parameters(context.get(), pyramid.get(), &derived) == PLC_OK);
  derived.curvature = 0.3;
  for (const plc_parameters& p : {s.parameters, softer, derived}) {
    const Run run = run_of(context.get(), pyramid.get(), p);
    advance(context.get(), run.get(), PLC_ALL_LEVELS);
    plc_parameters alone = p;
    CHECK(hash_now(context.get(), run.get()) ==
          plc_surface_hash(extract(context.get(), s.image, alone).get()));
  }
  // What the pyramid was made with is not the run's to change.
  for (const auto& change : std::vector<std::function<void(plc_parameters&)>>{
           [](auto& p) { p.iso = 0.4; }, [](auto& p) { p.levels = 1; },
           [](auto& p) { p.window_low = -1; }, [](auto& p) { p.reduction = 1.5; },
           [](auto& p) { p.pad_value = -2; }, [](auto& p) { p.inside_below = 1; }}) {
    plc_parameters p = s.parameters;
    change(p);
    plc_run* run = nullptr;
    CHECK(plc_run_create(context.get(), pyramid.get(), &p, nullptr, &run) == PLC_INVALID_ARGUMENT);
    CHECK_THAT(plc_context_message(context.get()), Contains("pyramid was made with"));
    CHECK(run == nullptr);
  }
}

TEST_CASE("a pyramid tells its levels and their values", "[pellicle_run]") {
  const Scene s;
  const Context context = make_context();
  plc_parameters p = s.parameters;
  p.window_low = 0;
  p.window_high = 1;
  plc_image image = s.image;
  image.origin[0] = 10;
  const Pyramid pyramid = pyramid_of(context.get(), image, p);
  REQUIRE(plc_pyramid_levels(pyramid.get()) == 2);
  double length = 0;
  for (int h = 0; h <= 2; ++h) {
    plc_pyramid_level level{};
    level.struct_size = sizeof level;
    REQUIRE(plc_pyramid_level_info(context.get(), pyramid.get(), h, &level) == PLC_OK);
    const int64_t count = level.dims[0] * level.dims[1] * level.dims[2];
    std::vector<float> values(static_cast<size_t>(count), -1);
    CHECK(plc_pyramid_values(context.get(), pyramid.get(), h, values.data(), count - 1) ==
          PLC_INVALID_ARGUMENT);
    REQUIRE(plc_pyramid_values(context.get(), pyramid.get(), h, values.data(), count) == PLC_OK);
    CHECK(*std::min_element(values.begin(), values.end()) >= 0);
    CHECK(*std::max_element(values.begin(), values.end()) <= 1);
    // The value at the middle of the first ball, in LPS, whatever the level.
    const double ball[3] = {10 + 17.5 - 9, 11.5, 10.5};
    int64_t at[3];
    for (int a = 0; a < 3; ++a) {
      at[a] = std::lround((ball[a] - level.origin[a]) / level.spacing[a]);
    }
    CHECK(values[static_cast<size_t>((at[2] * level.dims[1] + at[1]) * level.dims[0] + at[0])] >
          0.6);
    CHECK(level.unit == Approx(std::pow(p.reduction, h)));
    // All levels fill the same box.
    const double whole = level.spacing[0] * static_cast<double>(level.dims[0]);
    if (h == 0) length = whole;
    CHECK(whole == Approx(length));
    CHECK(level.origin[0] - level.spacing[0] / 2 == Approx(10 - 6.5));
  }
  plc_pyramid_level level{};
  level.struct_size = sizeof level;
  CHECK(plc_pyramid_level_info(context.get(), pyramid.get(), 3, &level) == PLC_INVALID_ARGUMENT);
  CHECK(std::string(plc_context_message(context.get())) == "level 3: the pyramid has 0 .. 2");
  CHECK(plc_pyramid_levels(nullptr) == -1);
}
