// The C API: contexts, extraction and its errors.
#include "engine/pellicle.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <thread>

#include "tests/samples/sample_api.h"
#include "tests/samples/sample_handles.h"

namespace {

using Catch::Matchers::Contains;
using samples::Context;
using samples::Surface;

const samples::Volume& ball() {
  static const samples::Volume volume =
      samples::sphere_potential(samples::empty_volume({18, 18, 18}), 0.33);
  return volume;
}

// The message of an extraction that must fail with the given status.
std::string failure(plc_status expected, const std::function<void(plc_image&)>& change_image,
                    const std::function<void(plc_parameters&)>& change_parameters = {}) {
  const Context context = samples::make_context();
  plc_image image = samples::image_of(ball());
  plc_parameters p = samples::parameters(0.5, 0);
  if (change_image) change_image(image);
  if (change_parameters) change_parameters(p);
  auto* surface = reinterpret_cast<plc_surface*>(&image);
  const plc_status status = plc_extract(context.get(), &image, &p, nullptr, &surface);
  CHECK(status == expected);
  CHECK(surface == nullptr);
  return plc_context_message(context.get());
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("the version is three numbers", "[pellicle]") {
  int major = -1, minor = -1, patch = -1;
  CHECK(std::sscanf(plc_version_string(), "%d.%d.%d", &major, &minor, &patch) == 3);
  CHECK(major == PLC_VERSION_MAJOR);
  CHECK(minor == PLC_VERSION_MINOR);
  CHECK(patch == PLC_VERSION_PATCH);
  CHECK(plc_version() == PLC_VERSION);
}

TEST_CASE("defaults are as the header says", "[pellicle]") {
  plc_context_options options;
  plc_context_options_defaults(&options);
  CHECK(options.struct_size == sizeof options);
  CHECK(options.threads == 0);
  CHECK(options.simd == PLC_SIMD_AUTO);
  plc_image image;
  plc_image_defaults(&image);
  CHECK(image.struct_size == sizeof image);
  CHECK(image.voxels == nullptr);
  for (int i = 0; i < 9; ++i) CHECK(image.direction[i] == (i % 4 == 0 ? 1 : 0));
  for (int i = 0; i < 3; ++i) {
    CHECK(image.spacing[i] == 1);
    CHECK(image.origin[i] == 0);
  }
  plc_parameters p;
  plc_parameters_defaults(&p);
  CHECK(p.struct_size == sizeof p);
  CHECK(std::isnan(p.iso));
  CHECK(std::isnan(p.window_low));
  CHECK(std::isnan(p.pad_value));
  CHECK(p.levels == -1);
  CHECK(p.reduction == Approx(std::sqrt(3.0)));
  CHECK(p.level_iso_count == 0);
  CHECK(p.anisotropy == PLC_ANISOTROPY_VOXEL);
}

TEST_CASE("a context tells its threads and SIMD target", "[pellicle]") {
  const Context three = samples::make_context(3, PLC_SIMD_SCALAR);
  CHECK(plc_context_threads(three.get()) == 3);
  CHECK(std::string(plc_context_simd(three.get())) == "scalar");
  CHECK(std::string(plc_context_message(three.get())).empty());
  plc_context* automatic = nullptr;
  REQUIRE(plc_context_create(nullptr, &automatic, nullptr, 0) == PLC_OK);
  CHECK(plc_context_threads(automatic) >= 1);
  CHECK_FALSE(std::string(plc_context_simd(automatic)).empty());
  plc_context_destroy(automatic);
  plc_context_destroy(nullptr);
}

TEST_CASE("a context that cannot be made is NULL and says why", "[pellicle]") {
  const auto error = [](const std::function<void(plc_context_options&)>& change,
                        size_t size = 200) {
    plc_context_options options;
    plc_context_options_defaults(&options);
    change(options);
    char text[200] = "untouched";
    auto* context = reinterpret_cast<plc_context*>(text);
    CHECK(plc_context_create(&options, &context, text, size) == PLC_INVALID_ARGUMENT);
    CHECK(context == nullptr);
    return std::string(text);
  };
  CHECK(error([](auto& o) { o.threads = -1; }) == "threads -1: must be 0 .. 1024");
  CHECK(error([](auto& o) { o.threads = 1025; }) == "threads 1025: must be 0 .. 1024");
  CHECK_THAT(error([](auto& o) { o.struct_size = 4; }), Contains("struct_size"));
  CHECK(error([](auto& o) { o.threads = -1; }, 8) == "threads");
  CHECK(error([](auto& o) { o.threads = -1; }, 0) == "untouched");
  char text[100];
  CHECK(plc_context_create(nullptr, nullptr, text, sizeof text) == PLC_INVALID_ARGUMENT);
  CHECK_THAT(std::string(text), Contains("NULL"));
  CHECK(plc_context_create(nullptr, nullptr, nullptr, 0) == PLC_INVALID_ARGUMENT);
}

TEST_CASE("targets that the machine lacks are refused by name", "[pellicle]") {
  const char* const kNames[] = {"scalar", "sse4", "avx2", "avx512", "neon", "wasm"};
  for (int target = PLC_SIMD_SCALAR; target <= PLC_SIMD_WASM; ++target) {
    plc_context_options options;
    plc_context_options_defaults(&options);
    options.simd = static_cast<plc_simd>(target);
    plc_context* context = nullptr;
    char text[200];
    const std::string name = kNames[target - 1];
    if (plc_context_create(&options, &context, text, sizeof text) == PLC_OK) {
      CHECK(plc_context_simd(context) == name);
      plc_context_destroy(context);
    } else {
      CHECK(std::string(text) == "simd " + name + ": this machine does not have it");
    }
  }
}

TEST_CASE("NULL for anything that is needed is an error, not a crash", "[pellicle]") {
  const Context context = samples::make_context();
  const plc_image image = samples::image_of(ball());
  const plc_parameters p = samples::parameters(0.5, 0);
  plc_surface* surface = nullptr;
  CHECK(plc_extract(nullptr, &image, &p, nullptr, &surface) == PLC_INVALID_ARGUMENT);
  CHECK(plc_extract(context.get(), nullptr, &p, nullptr, &surface) == PLC_INVALID_ARGUMENT);
  CHECK(plc_extract(context.get(), &image, nullptr, nullptr, &surface) == PLC_INVALID_ARGUMENT);
  CHECK(plc_extract(context.get(), &image, &p, nullptr, nullptr) == PLC_INVALID_ARGUMENT);
  CHECK_THAT(std::string(plc_context_message(context.get())), Contains("must not be NULL"));
  plc_measures measures{};
  CHECK(plc_surface_measure(context.get(), nullptr, PLC_SPACE_LPS, &measures) ==
        PLC_INVALID_ARGUMENT);
  CHECK(plc_surface_measure(nullptr, nullptr, PLC_SPACE_LPS, nullptr) == PLC_INVALID_ARGUMENT);
  CHECK(plc_check_mesh(context.get(), nullptr, 0, nullptr, 0, nullptr) == PLC_INVALID_ARGUMENT);
  CHECK(plc_check_mesh(nullptr, nullptr, 0, nullptr, 0, nullptr) == PLC_INVALID_ARGUMENT);
  plc_surface_destroy(nullptr);
}

TEST_CASE("structs of another size are refused", "[pellicle]") {
  CHECK_THAT(failure(PLC_INVALID_ARGUMENT, [](plc_image& i) { i.struct_size = 0; }),
             Contains("struct_size"));
  CHECK_THAT(failure(PLC_INVALID_ARGUMENT, {}, [](plc_parameters& p) { p.struct_size += 8; }),
             Contains("struct_size"));
}

TEST_CASE("an image that cannot be used is refused in words", "[pellicle]") {
  CHECK(failure(PLC_INVALID_ARGUMENT, [](plc_image& i) { i.voxels = nullptr; }) ==
        "image: no voxels");
  for (const int64_t dim : {int64_t{1}, int64_t{0}, int64_t{-5}}) {
    CHECK(failure(PLC_INVALID_DATA, [&](plc_image& i) { i.dims[1] = dim; }) ==
          "image of 18 x " + std::to_string(dim) +
              " x 18 voxels: at least 2 are needed on every axis");
  }
  for (const double spacing : {0.0, -1.0, kNan, HUGE_VAL}) {
    CHECK_THAT(failure(PLC_INVALID_DATA, [&](plc_image& i) { i.spacing[2] = spacing; }),
               Contains("spacing") && Contains("expected a length from 1e-30"));
  }
  CHECK_THAT(failure(PLC_INVALID_DATA, [](plc_image& i) { i.origin[0] = kNan; }),
             Contains("origin nan"));
  for (const double spacing : {1e-31, 1e31}) {
    CHECK_THAT(failure(PLC_INVALID_DATA, [&](plc_image& i) { i.spacing[1] = spacing; }),
               Contains("spacing"));
  }
  CHECK_THAT(failure(PLC_INVALID_DATA, [](plc_image& i) { i.origin[2] = -1e31; }),
             Contains("origin -1e+31"));
  CHECK_THAT(failure(PLC_INVALID_DATA, [](plc_image& i) { i.direction[4] = 1.1; }),
             Contains("direction cosines of length 1.1, expected 1"));
  CHECK_THAT(failure(PLC_INVALID_DATA, [](plc_image& i) { i.direction[4] = 0; }),
             Contains("direction cosines are singular"));
  for (const double cosine : {kNan, HUGE_VAL}) {
    CHECK_THAT(failure(PLC_INVALID_DATA, [&](plc_image& i) { i.direction[4] = cosine; }),
               Contains("direction cosines"));
  }
}

TEST_CASE("voxels that are NaN or infinite are counted and refused", "[pellicle]") {
  samples::Volume bad = ball();
  bad.values[100] = std::numeric_limits<float>::quiet_NaN();
  bad.values[5000] = -std::numeric_limits<float>::infinity();
  CHECK(failure(PLC_INVALID_DATA, [&](plc_image& i) { i.voxels = bad.values.data(); }) ==
        "image: 2 voxels are NaN or infinite");
}

TEST_CASE("parameters that cannot be used are refused in words", "[pellicle]") {
  const auto refused = [](const std::function<void(plc_parameters&)>& change) {
    return failure(PLC_INVALID_ARGUMENT, {}, change);
  };
  CHECK(refused([](plc_parameters& p) { p.iso = kNan; }) == "iso: not set");
  CHECK_THAT(refused([](plc_parameters& p) { p.iso = 2; }), Contains("outside the image's range"));
  CHECK_THAT(refused([](plc_parameters& p) { p.mass = -1; }), Contains("mass -1"));
  CHECK_THAT(refused([](plc_parameters& p) { p.time_step = 0; }), Contains("time step 0"));
  CHECK_THAT(refused([](plc_parameters& p) { p.levels = 20; }), Contains("levels"));
  CHECK_THAT(refused([](plc_parameters& p) {
               p.init = PLC_INIT_BUBBLES;
               p.bubbles[0] = p.bubbles[1] = p.bubbles[2] = 200;
             }),
             Contains("bubbles 200 x 200 x 200"));
  CHECK_THAT(failure(PLC_INVALID_DATA, {},
                     [](plc_parameters& p) {
                       p.iso = 0.9;
                       p.spring = 20;
                       p.rest_length = PLC_REST_ZERO;
                     }),
             Contains("no surface"));
}

TEST_CASE("a constant image has no surface", "[pellicle]") {
  samples::Volume flat = ball();
  flat.values.assign(flat.values.size(), 0.5F);
  CHECK_THAT(failure(PLC_INVALID_DATA, [&](plc_image& i) { i.voxels = flat.values.data(); }),
             Contains("constant image"));
}

TEST_CASE("a context is good for the next call after a failure", "[pellicle]") {
  const Context context = samples::make_context();
  const plc_image image = samples::image_of(ball());
  plc_parameters p = samples::parameters(7, 0);
  plc_surface* surface = nullptr;
  CHECK(plc_extract(context.get(), &image, &p, nullptr, &surface) == PLC_INVALID_ARGUMENT);
  CHECK_FALSE(std::string(plc_context_message(context.get())).empty());
  p.iso = 0.5;
  const Surface good = samples::extract(context.get(), image, p);
  CHECK(plc_surface_vertex_count(good.get()) > 100);
  CHECK(std::string(plc_context_message(context.get())).empty());
}

TEST_CASE("progress is told after every iteration and may cancel", "[pellicle]") {
  const Context context = samples::make_context();
  const plc_image image = samples::image_of(ball());
  const plc_parameters p = samples::parameters(0.5, 1);
  struct Told {
    int calls = 0, limit = 0;
    double fraction = 0, seconds = 0;
  };
  const plc_progress_fn listen = [](const plc_progress* progress, void* user) {
    auto& told = *static_cast<Told*>(user);
    ++told.calls;
    CHECK(progress->struct_size == sizeof *progress);
    CHECK(progress->levels == 1);
    CHECK(progress->iteration >= 1);
    CHECK(progress->vertices > 0);
    CHECK(progress->fraction >= told.fraction);
    CHECK(progress->seconds >= told.seconds);
    told.fraction = progress->fraction;
    told.seconds = progress->seconds;
    return told.calls == told.limit ? 1 : 0;
  };
  Told told;
  plc_surface* surface = nullptr;
  plc_extras extras;
  plc_extras_defaults(&extras);
  extras.progress = listen;
  extras.progress_user = &told;
  REQUIRE(plc_extract(context.get(), &image, &p, &extras, &surface) == PLC_OK);
  int64_t iterations = 0;
  for (int i = 0; i < plc_surface_level_count(surface); ++i) {
    iterations += samples::level_of(surface, i).iterations;
  }
  CHECK(told.calls == iterations);
  plc_surface_destroy(surface);
  told = {};
  told.limit = 9;
  CHECK(plc_extract(context.get(), &image, &p, &extras, &surface) == PLC_CANCELLED);
  CHECK(told.calls == 9);
  CHECK(surface == nullptr);
  CHECK(std::string(plc_context_message(context.get())) == "cancelled");
}

TEST_CASE("making the iso-surface to start from is told, and may be cancelled at any time",
          "[pellicle]") {
  const Context context = samples::make_context();
  const plc_image image = samples::image_of(ball());
  const plc_parameters p = samples::parameters(0.5, -1);
  struct Told {
    int starts = 0, iterations = 0, limit = 0;
    double fraction = 0;
  };
  Told told;
  plc_extras extras;
  plc_extras_defaults(&extras);
  extras.progress = [](const plc_progress* progress, void* user) {
    auto& so_far = *static_cast<Told*>(user);
    (progress->iteration == 0 ? so_far.starts : so_far.iterations) += 1;
    CHECK(progress->level == 0);
    CHECK(progress->fraction >= so_far.fraction);
    CHECK(progress->fraction > 0);
    if (progress->iteration == 0) CHECK((so_far.iterations == 0 && progress->vertices == 0));
    so_far.fraction = progress->fraction;
    return so_far.starts == so_far.limit ? 1 : 0;
  };
  extras.progress_user = &told;
  plc_surface* surface = nullptr;
  REQUIRE(plc_extract(context.get(), &image, &p, &extras, &surface) == PLC_OK);
  const Surface made(surface);
  CHECK(samples::parameters_of(made.get()).init == PLC_INIT_ISO);
  CHECK(told.iterations == samples::level_of(made.get(), 0).iterations);
  const int starts = told.starts;
  CHECK(starts > 2);
  plc_volume* volume = nullptr;
  REQUIRE(plc_volume_create(context.get(), &image, PLC_COPY, &volume) == PLC_OK);
  const samples::VolumeHandle given(volume);
  plc_pyramid* images = nullptr;
  REQUIRE(plc_pyramid_create(context.get(), volume, &p, &images) == PLC_OK);
  const samples::PyramidHandle pyramid(images);
  for (int limit = 1; limit <= starts; ++limit) {
    told = {0, 0, limit, 0};
    CHECK(plc_extract(context.get(), &image, &p, &extras, &surface) == PLC_CANCELLED);
    CHECK(surface == nullptr);
    told = {0, 0, limit, 0};
    plc_run* run = nullptr;
    CHECK(plc_run_create(context.get(), images, &p, &extras, &run) == PLC_CANCELLED);
    CHECK(run == nullptr);
    CHECK(told.starts == limit);
    CHECK(told.iterations == 0);
  }
}

TEST_CASE("a level tells how many vertices it has moved and checked", "[pellicle]") {
  const Context context = samples::make_context();
  // From a seed at one end of a bar: that end rests while the other one is not reached.
  const samples::Volume bar =
      samples::sampled(samples::empty_volume({60, 14, 14}), [](const samples::Point& p) {
        return 0.5 + std::min({25 - std::abs(p[0]), 3.5 - std::abs(p[1]), 3.5 - std::abs(p[2])});
      });
  const plc_image image = samples::image_of(bar);
  const plc_seed seed{{8, 6.5, 6.5}, 3};
  const auto level = [&](int sleeping) {
    plc_parameters p = samples::parameters(0.5, 0);
    p.init = PLC_INIT_SEEDS;
    p.sleeping = sleeping;
    plc_extras extras;
    plc_extras_defaults(&extras);
    extras.space = PLC_SPACE_VOXEL;
    extras.seeds = &seed;
    extras.seed_count = 1;
    const Surface surface = samples::extract(context.get(), image, p, &extras);
    return samples::level_of(surface.get(), 0);
  };
  const plc_level_report all = level(0), some = level(1);
  CHECK(all.checks < all.moves);
  CHECK(some.checks > 0);
  CHECK(some.moves < all.moves * some.iterations / all.iterations);
}

TEST_CASE("every voxel type gives the same surface of the same values", "[pellicle]") {
  const Context context = samples::make_context();
  std::vector<uint8_t> u8;
  std::vector<int16_t> i16;
  std::vector<uint16_t> u16;
  std::vector<int32_t> i32;
  std::vector<float> f32;
  // Beyond its window, too.
  samples::Volume noisy = ball();
  samples::add_noise(noisy, 0.1, 5);
  for (float& value : noisy.values) value = std::clamp(value, 0.0F, 1.2F);
  for (const float value : noisy.values) {
    u8.push_back(static_cast<uint8_t>(value * 200));
    i16.push_back(u8.back());
    u16.push_back(u8.back());
    i32.push_back(u8.back());
    f32.push_back(u8.back());
  }
  const void* const kVoxels[] = {u8.data(), i16.data(), u16.data(), i32.data(), f32.data()};
  std::vector<uint64_t> hashes;
  for (int type = PLC_U8; type <= PLC_F32; ++type) {
    plc_image image = samples::image_of(ball());
    image.type = static_cast<plc_voxel_type>(type);
    image.voxels = kVoxels[type];
    const Surface surface = samples::extract(context.get(), image, samples::parameters(100.5, 1));
    hashes.push_back(plc_surface_hash(surface.get()));
    CHECK(samples::range_of(surface.get())[0] == 0);
    CHECK(samples::range_of(surface.get())[1] == *std::max_element(u8.begin(), u8.end()));
  }
  for (const uint64_t hash : hashes) CHECK(hash == hashes[0]);
}

TEST_CASE("contexts work side by side in threads of their own", "[pellicle]") {
  const plc_image image = samples::image_of(ball());
  const plc_parameters p = samples::parameters(0.5, 1);
  constexpr size_t kContexts = 4;
  uint64_t hashes[kContexts] = {};
  std::vector<std::thread> threads;
  for (size_t i = 0; i < kContexts; ++i) {
    threads.emplace_back([&, i] {
      plc_context_options options;
      plc_context_options_defaults(&options);
      options.threads = static_cast<int>(i) + 1;
      plc_context* context = nullptr;
      plc_surface* surface = nullptr;
      if (plc_context_create(&options, &context, nullptr, 0) != PLC_OK) return;
      if (plc_extract(context, &image, &p, nullptr, &surface) == PLC_OK) {
        hashes[i] = plc_surface_hash(surface);
      }
      plc_surface_destroy(surface);
      plc_context_destroy(context);
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(hashes[0] != 0);
  for (const uint64_t hash : hashes) CHECK(hash == hashes[0]);
}
