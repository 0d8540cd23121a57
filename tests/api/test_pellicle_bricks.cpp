// Volumes of bricks: the same surface as that of the image in memory, within a limit of memory.
#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <mutex>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"

namespace {

using Catch::Matchers::Contains;
using samples::Context;
using samples::Surface;
using samples::VolumeHandle;

constexpr std::array<int64_t, 3> kDims{70, 61, 52};

// Balls that overlap, one that coarse levels lose, and one that the image cuts; some ripple, so
// that no two bricks are the same.
template <typename T>
std::vector<T> balls(double background = 0) {
  std::vector<T> voxels;
  for (int64_t z = 0; z < kDims[2]; ++z) {
    for (int64_t y = 0; y < kDims[1]; ++y) {
      for (int64_t x = 0; x < kDims[0]; ++x) {
        double value = background;
        const auto ball = [&](double cx, double cy, double cz, double r) {
          const auto dx = static_cast<double>(x) - cx, dy = static_cast<double>(y) - cy,
                     dz = static_cast<double>(z) - cz;
          const double inside = r - std::sqrt(dx * dx + dy * dy + dz * dz);
          value = std::max(value, std::clamp(100 + 50 * inside, background, 200.0));
        };
        ball(25, 28, 24, 13);
        ball(38, 30, 26, 11);
        ball(60, 50, 44, 3.2);
        ball(0, 20, 30, 6);
        if (value > background) value += static_cast<double>((x * 7 + y * 5 + z * 3) % 11);
        voxels.push_back(static_cast<T>(value));
      }
    }
  }
  return voxels;
}

// A host that has the voxels, and counts who asks for them.
template <typename T>
struct Shelf {
  std::vector<T> voxels = balls<T>();
  std::array<int64_t, 3> brick{16, 17, 16};
  int64_t fails_after = std::numeric_limits<int64_t>::max();
  std::string complaint = "the shelf is broken";
  std::atomic<int64_t> asked{0};

  static plc_voxel_type type() {
    if constexpr (sizeof(T) == 1) return PLC_U8;
    if constexpr (sizeof(T) == 4) return PLC_F32;
    return std::numeric_limits<T>::is_signed ? PLC_I16 : PLC_U16;
  }

  static int fetch(const int64_t at[3], void* to, char* message, size_t size, void* user) {
    auto& self = *static_cast<Shelf*>(user);
    if (self.asked++ >= self.fails_after) {
      std::snprintf(message, size, "%s", self.complaint.c_str());
      return 1;
    }
    auto* out = static_cast<T*>(to);
    for (int64_t z = 0; z < self.brick[2]; ++z) {
      for (int64_t y = 0; y < self.brick[1]; ++y) {
        for (int64_t x = 0; x < self.brick[0]; ++x, ++out) {
          const int64_t i = at[0] * self.brick[0] + x, j = at[1] * self.brick[1] + y,
                        k = at[2] * self.brick[2] + z;
          if (i >= kDims[0] || j >= kDims[1] || k >= kDims[2]) continue;
          *out = self.voxels[static_cast<size_t>((k * kDims[1] + j) * kDims[0] + i)];
        }
      }
    }
    return 0;
  }

  plc_bricks bricks(int64_t cache) {
    plc_bricks b;
    plc_bricks_defaults(&b);
    b.type = type();
    std::copy_n(kDims.data(), 3, b.dims);
    std::copy_n(brick.data(), 3, b.brick);
    b.spacing[2] = 1.25;
    b.fetch = fetch;
    b.user = this;
    b.cache = cache;
    return b;
  }
  plc_image image() const {
    plc_image i;
    plc_image_defaults(&i);
    i.type = type();
    i.voxels = voxels.data();
    std::copy_n(kDims.data(), 3, i.dims);
    i.spacing[2] = 1.25;
    return i;
  }
};

VolumeHandle volume_of(plc_context* context, const plc_bricks& bricks) {
  plc_volume* volume = nullptr;
  const plc_status status = plc_volume_create_bricks(context, &bricks, &volume);
  INFO(plc_context_message(context));
  REQUIRE(status == PLC_OK);
  return VolumeHandle(volume);
}

plc_brick_counts counts_of(plc_context* context, const plc_volume* volume) {
  plc_brick_counts counts;
  plc_brick_counts_defaults(&counts);
  REQUIRE(plc_volume_brick_counts(context, volume, &counts) == PLC_OK);
  return counts;
}

uint64_t extracted(plc_context* context, const plc_volume* volume, const plc_parameters& p) {
  plc_surface* surface = nullptr;
  const plc_status status = plc_extract_volume(context, volume, &p, nullptr, &surface);
  INFO(plc_context_message(context));
  REQUIRE(status == PLC_OK);
  return plc_surface_hash(Surface(surface).get());
}

std::string refused(plc_context* context, const plc_bricks& bricks, plc_status expected) {
  plc_volume* volume = nullptr;
  CHECK(plc_volume_create_bricks(context, &bricks, &volume) == expected);
  CHECK(volume == nullptr);
  return plc_context_message(context);
}

// All levels in memory; only the coarsest; none, and of I_0 next to nothing.
constexpr std::array<int64_t, 3> kCaches{1 << 30, 1 << 17, 1};

}  // namespace

TEMPLATE_TEST_CASE("bricks give the bits of the image in memory", "[bricks]", uint8_t, int16_t,
                   uint16_t, float) {
  Shelf<TestType> shelf;
  plc_parameters p = samples::parameters(100, 2);
  const Context first = samples::make_context();
  const uint64_t expected = plc_surface_hash(samples::extract(first.get(), shelf.image(), p).get());
  for (const int64_t cache : kCaches) {
    for (const plc_simd simd : {PLC_SIMD_AUTO, PLC_SIMD_SCALAR}) {
      CAPTURE(cache, simd);
      const Context context = samples::make_context(3, simd);
      const VolumeHandle volume = volume_of(context.get(), shelf.bricks(cache));
      CHECK(extracted(context.get(), volume.get(), p) == expected);
    }
  }
}

TEST_CASE("bricks give the bits of the image in memory: other meshes, forces and starts",
          "[bricks]") {
  Shelf<int16_t> shelf;
  std::vector<plc_parameters> asked(4, samples::parameters(100, 2));
  asked[0].mesh = PLC_MESH_ADAPTIVE;
  asked[1].force = PLC_FORCE_BOTH;
  asked[2].init = PLC_INIT_ISO;
  asked[2].levels = 0;
  asked[3].inside_below = 1;
  asked[3].level_iso_count = 3;
  std::fill_n(asked[3].level_iso, 3, 100);
  for (size_t i = 0; i < asked.size(); ++i) {
    const Context context = samples::make_context(2);
    const Surface expected = samples::extract(context.get(), shelf.image(), asked[i]);
    for (const int64_t cache : kCaches) {
      CAPTURE(i, cache);
      const VolumeHandle volume = volume_of(context.get(), shelf.bricks(cache));
      CHECK(extracted(context.get(), volume.get(), asked[i]) == plc_surface_hash(expected.get()));
    }
  }
}

TEST_CASE("a brick is fetched once where the cache holds the image, and again where it does not",
          "[bricks]") {
  Shelf<int16_t> shelf;
  const Context context = samples::make_context(2);
  const plc_parameters p = samples::parameters(100, 2);
  const VolumeHandle all = volume_of(context.get(), shelf.bricks(1 << 30));
  extracted(context.get(), all.get(), p);
  plc_brick_counts counts = counts_of(context.get(), all.get());
  CHECK(counts.bricks == 5 * 4 * 4);
  CHECK(counts.read == counts.bricks);
  CHECK(counts.read_again == 0);
  CHECK(shelf.asked == counts.read);
  for (size_t i = 0; i < shelf.voxels.size(); ++i) shelf.voxels[i] = static_cast<int16_t>(i % 97);
  const VolumeHandle some = volume_of(context.get(), shelf.bricks(1));
  for (int i = 0; i < 3; ++i) {
    double low = 0, high = 0;
    REQUIRE(plc_volume_range(context.get(), some.get(), &low, &high) == PLC_OK);
  }
  counts = counts_of(context.get(), some.get());
  CHECK(counts.read_again > counts.bricks / 2);
  CHECK(counts.read - counts.read_again == counts.bricks);
}

TEST_CASE("bricks of one value take no memory", "[bricks]") {
  Shelf<uint8_t> shelf;
  std::fill(shelf.voxels.begin(), shelf.voxels.end(), uint8_t{7});
  shelf.voxels[0] = 200;
  const Context context = samples::make_context();
  const VolumeHandle volume = volume_of(context.get(), shelf.bricks(1));
  double low = 0, high = 0;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(plc_volume_range(context.get(), volume.get(), &low, &high) == PLC_OK);
    CHECK(low == 7);
    CHECK(high == 200);
  }
  const plc_brick_counts counts = counts_of(context.get(), volume.get());
  CHECK(counts.read - counts.read_again == counts.bricks);
  CHECK(counts.read == counts.bricks);
}

TEST_CASE("bricks make room for everything else within the limit of the context", "[bricks]") {
  Shelf<float> shelf;
  for (size_t i = 0; i < shelf.voxels.size(); ++i) shelf.voxels[i] += static_cast<float>(i % 7);
  const plc_parameters p = samples::parameters(100, 0);
  const auto run = [&](int64_t limit, plc_status expected) {
    plc_context_options options;
    plc_context_options_defaults(&options);
    options.threads = 1;  // so that runs take the same memory
    options.memory_limit = limit;
    plc_context* made = nullptr;
    REQUIRE(plc_context_create(&options, &made, nullptr, 0) == PLC_OK);
    const Context context(made);
    const VolumeHandle volume = volume_of(context.get(), shelf.bricks(1 << 30));
    plc_surface* surface = nullptr;
    const plc_status status = plc_extract_volume(made, volume.get(), &p, nullptr, &surface);
    INFO(plc_context_message(made));
    CHECK(status == expected);
    const uint64_t hash = surface == nullptr ? 0 : plc_surface_hash(Surface(surface).get());
    int64_t peak = 0;
    REQUIRE(plc_context_memory(made, nullptr, &peak) == PLC_OK);
    if (limit != 0) CHECK(peak <= limit);
    return std::array<int64_t, 3>{static_cast<int64_t>(hash), peak,
                                  counts_of(made, volume.get()).read_again};
  };
  const auto [hash, peak, again] = run(0, PLC_OK);
  CHECK(again == 0);
  const auto voxels = static_cast<int64_t>(shelf.voxels.size() * sizeof(float));
  // A quarter of the image less than it took.
  const auto tight = run(peak - voxels / 4, PLC_OK);
  CHECK(tight[0] == hash);
  CHECK(tight[2] > 0);
  run(1 << 20, PLC_OUT_OF_MEMORY);
}

TEST_CASE("a brick that cannot be fetched ends the call by its message", "[bricks]") {
  Shelf<int16_t> shelf;
  const Context context = samples::make_context(3);
  const plc_parameters p = samples::parameters(100, 2);
  int64_t all = 0;
  {
    const VolumeHandle volume = volume_of(context.get(), shelf.bricks(1 << 16));
    extracted(context.get(), volume.get(), p);
    all = shelf.asked;
  }
  for (const int64_t after : {int64_t{0}, all / 7, all / 2}) {
    CAPTURE(after, all);
    shelf.asked = 0;
    shelf.fails_after = after;
    shelf.complaint = after == 0 ? "two\nlines" : "";
    const VolumeHandle volume = volume_of(context.get(), shelf.bricks(1 << 16));
    plc_surface* surface = nullptr;
    CHECK(plc_extract_volume(context.get(), volume.get(), &p, nullptr, &surface) ==
          PLC_INVALID_DATA);
    CHECK(surface == nullptr);
    const std::string message = plc_context_message(context.get());
    if (after == 0) {
      CHECK(message == "two lines");
    } else {
      CHECK_THAT(message, Contains("could not be fetched"));
    }
  }
}

TEST_CASE("a run of bricks goes on from a state that was saved of the image in memory",
          "[bricks]") {
  Shelf<int16_t> shelf;
  const Context context = samples::make_context(2);
  plc_parameters p = samples::parameters(100, 1);
  const auto pyramid_of = [&](const plc_volume* volume) {
    plc_pyramid* pyramid = nullptr;
    REQUIRE(plc_pyramid_create(context.get(), volume, &p, &pyramid) == PLC_OK);
    return samples::PyramidHandle(pyramid);
  };
  const auto hash_of = [&](plc_run* run) {
    REQUIRE(plc_run_advance(context.get(), run, PLC_ALL_LEVELS, nullptr) == PLC_OK);
    plc_surface* surface = nullptr;
    REQUIRE(plc_run_surface(context.get(), run, &surface) == PLC_OK);
    return plc_surface_hash(Surface(surface).get());
  };
  plc_volume* made = nullptr;
  const plc_image image = shelf.image();
  REQUIRE(plc_volume_create(context.get(), &image, PLC_BORROW, &made) == PLC_OK);
  const VolumeHandle memory(made);
  const samples::PyramidHandle whole = pyramid_of(memory.get());
  plc_run* run = nullptr;
  REQUIRE(plc_run_create(context.get(), whole.get(), &p, nullptr, &run) == PLC_OK);
  const samples::RunHandle first(run);
  for (int i = 0; i < 20; ++i) {
    REQUIRE(plc_run_advance(context.get(), run, PLC_ONE_ITERATION, nullptr) == PLC_OK);
  }
  size_t size = 0;
  REQUIRE(plc_run_save(context.get(), run, nullptr, 0, &size) == PLC_OK);
  std::vector<uint8_t> state(size);
  REQUIRE(plc_run_save(context.get(), run, state.data(), size, &size) == PLC_OK);

  const VolumeHandle volume = volume_of(context.get(), shelf.bricks(1 << 16));
  const samples::PyramidHandle bricks = pyramid_of(volume.get());
  plc_run* again = nullptr;
  const plc_status status =
      plc_run_restore(context.get(), bricks.get(), &p, nullptr, state.data(), state.size(), &again);
  INFO(plc_context_message(context.get()));
  REQUIRE(status == PLC_OK);
  const samples::RunHandle second(again);
  CHECK(hash_of(again) == hash_of(run));
}

TEST_CASE("the pyramid of bricks can be read, the voxels cannot", "[bricks]") {
  Shelf<uint8_t> shelf;
  const Context context = samples::make_context(2);
  const plc_parameters p = samples::parameters(100, 2);
  const VolumeHandle volume = volume_of(context.get(), shelf.bricks(1 << 12));
  plc_image image;
  plc_image_defaults(&image);
  REQUIRE(plc_volume_image(context.get(), volume.get(), &image) == PLC_OK);
  CHECK(image.voxels == nullptr);
  CHECK(image.spacing[2] == 1.25);
  plc_volume* made = nullptr;
  const plc_image whole = shelf.image();
  REQUIRE(plc_volume_create(context.get(), &whole, PLC_BORROW, &made) == PLC_OK);
  const VolumeHandle memory(made);
  std::array<std::vector<std::vector<float>>, 2> levels;
  for (size_t i = 0; i < 2; ++i) {
    plc_pyramid* pyramid = nullptr;
    REQUIRE(plc_pyramid_create(context.get(), i == 0 ? memory.get() : volume.get(), &p, &pyramid) ==
            PLC_OK);
    const samples::PyramidHandle handle(pyramid);
    for (int h = 0; h <= 2; ++h) {
      plc_pyramid_level level;
      plc_pyramid_level_defaults(&level);
      REQUIRE(plc_pyramid_level_info(context.get(), pyramid, h, &level) == PLC_OK);
      std::vector<float> values(static_cast<size_t>(level.dims[0] * level.dims[1] * level.dims[2]));
      REQUIRE(plc_pyramid_values(context.get(), pyramid, h, values.data(),
                                 static_cast<int64_t>(values.size())) == PLC_OK);
      levels[i].push_back(values);
    }
  }
  CHECK(levels[0] == levels[1]);
}

TEST_CASE("what is no volume of bricks is refused", "[bricks]") {
  Shelf<int16_t> shelf;
  const Context context = samples::make_context();
  const auto with = [&](auto change) {
    plc_bricks b = shelf.bricks(0);
    change(b);
    return b;
  };
  const auto said = [&](auto change, plc_status status) {
    return refused(context.get(), with(change), status);
  };
  CHECK_THAT(said([](plc_bricks& b) { b.fetch = nullptr; }, PLC_INVALID_ARGUMENT),
             Contains("fetch"));
  CHECK_THAT(said([](plc_bricks& b) { b.type = PLC_I32; }, PLC_INVALID_ARGUMENT), Contains("type"));
  CHECK_THAT(said([](plc_bricks& b) { b.brick[1] = 8; }, PLC_INVALID_ARGUMENT),
             Contains("8 voxels"));
  CHECK_THAT(said([](plc_bricks& b) { b.cache = -1; }, PLC_INVALID_ARGUMENT), Contains("cache"));
  CHECK_THAT(said([](plc_bricks& b) { b.dims[0] = 1; }, PLC_INVALID_DATA), Contains("at least 2"));
  CHECK_THAT(
      said([](plc_bricks& b) { b.dims[0] = b.dims[1] = int64_t{1} << 20; }, PLC_INVALID_DATA),
      Contains("fewer than 2^31"));
  CHECK_THAT(said([](plc_bricks& b) { b.spacing[0] = 0; }, PLC_INVALID_DATA), Contains("spacing"));

  const VolumeHandle volume = volume_of(context.get(), shelf.bricks(0));
  plc_parameters p = samples::parameters(100, 1);
  p.feature = PLC_FEATURE_GRADIENT_NORM;
  plc_surface* surface = nullptr;
  CHECK(plc_extract_volume(context.get(), volume.get(), &p, nullptr, &surface) ==
        PLC_INVALID_ARGUMENT);
  CHECK_THAT(plc_context_message(context.get()), Contains("feature"));
  CHECK(plc_extract_volume(context.get(), nullptr, &p, nullptr, &surface) == PLC_INVALID_ARGUMENT);

  Shelf<float> holes;
  holes.voxels[1234] = NAN;
  const VolumeHandle nan = volume_of(context.get(), holes.bricks(0));
  p.feature = PLC_FEATURE_NONE;
  CHECK(plc_extract_volume(context.get(), nan.get(), &p, nullptr, &surface) == PLC_INVALID_DATA);
  CHECK_THAT(plc_context_message(context.get()), Contains("1 voxels are NaN"));
}
