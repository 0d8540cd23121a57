#include "pyramid/window.h"

#include <catch2/catch.hpp>
#include <functional>

#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_surfaces.h"

namespace {

using plc::VoxelType;
using Window = plc::DerivedWindow;

constexpr int64_t kSide = 24;

// value(x, y, z), rounded to the type.
template <typename Voxel>
std::vector<Voxel> image_of(const std::function<double(int64_t, int64_t, int64_t)>& value) {
  std::vector<Voxel> voxels;
  for (int64_t z = 0; z < kSide; ++z) {
    for (int64_t y = 0; y < kSide; ++y) {
      for (int64_t x = 0; x < kSide; ++x) voxels.push_back(static_cast<Voxel>(value(x, y, z)));
    }
  }
  return voxels;
}

template <typename Voxel>
Window window_of(VoxelType type, const std::vector<Voxel>& voxels, double iso, bool above,
                 const plc::Executor& executor = samples::kSerial) {
  const plc::VolumeView view{type, voxels.data(), {kSide, kSide, kSide}, {1, 1, 1}};
  const plc::VoxelRange range = plc::voxel_range(view, executor);
  return plc::derive_window(view, range, iso, above, executor);
}

// A block of 100 in 40, a spot of 250 inside it and of 0 outside, both away from its surface.
double block(int64_t x, int64_t y, int64_t z) {
  const auto inside = [](int64_t i) { return i >= 6 && i < 18; };
  if (x == 12 && y == 12 && z == 12) return 250;
  if (x == 1 && y == 1 && z == 1) return 0;
  return inside(x) && inside(y) && inside(z) ? 100 : 40;
}

}  // namespace

TEST_CASE("the window reaches out from the iso-value by the values across the surface",
          "[window]") {
  const auto voxels = image_of<uint8_t>(block);
  const Window window = window_of(VoxelType::kU8, voxels, 60, true);
  // 20 below to the background, doubled; 40 above to the object, five times.
  CHECK(window.background == Approx(40).margin(0.1));
  CHECK(window.low == Approx(20).margin(0.3));
  CHECK(window.high == Approx(250).margin(0.01));  // 260, within the range
  CHECK(window_of(VoxelType::kU8, voxels, 50, true).low == Approx(30).margin(0.3));
}

TEST_CASE("for a dark object the reaches are the other way round", "[window]") {
  const auto voxels =
      image_of<int16_t>([](int64_t x, int64_t y, int64_t z) { return 1000 - block(x, y, z); });
  // The object is 900 in 960.
  const Window window = window_of(VoxelType::kI16, voxels, 940, false);
  CHECK(window.background == Approx(960).margin(0.1));
  CHECK(window.high == Approx(980).margin(0.3));
  CHECK(window.low == Approx(750).margin(0.01));
}

TEST_CASE("voxels away from the surface play no part", "[window]") {
  const auto plain = image_of<float>([](int64_t x, int64_t y, int64_t z) {
    const double v = block(x, y, z);
    return v == 250 ? 100 : v == 0 ? 40 : v;
  });
  auto far = plain;
  // Everything deep inside or far outside is something else; the range is the same.
  for (int64_t z = 0; z < kSide; ++z) {
    for (int64_t y = 0; y < kSide; ++y) {
      for (int64_t x = 0; x < kSide; ++x) {
        const bool deep = x >= 8 && x < 16 && y >= 8 && y < 16 && z >= 8 && z < 16;
        if (deep) far[static_cast<size_t>((z * kSide + y) * kSide + x)] = 90;
      }
    }
  }
  const Window one = window_of(VoxelType::kF32, plain, 70, true);
  const Window other = window_of(VoxelType::kF32, far, 70, true);
  CHECK(one.low == other.low);
  CHECK(one.high == other.high);
  CHECK(one.background == other.background);
}

TEST_CASE("the window holds the iso-value inside, also at the ends of the range", "[window]") {
  const auto voxels = image_of<uint8_t>(block);
  for (const bool above : {true, false}) {
    for (const double iso : {0.001, 1.0, 39.9, 40.0, 40.1, 99.9, 100.0, 100.1, 249.9, 250.0}) {
      if (!above && iso == 250.0) continue;
      const Window window = window_of(VoxelType::kU8, voxels, iso, above);
      CAPTURE(above, iso);
      CHECK(window.low < iso);
      CHECK(iso < window.high);
      CHECK(window.high - window.low >= 0.25);  // a thousandth of the range
    }
  }
}

TEST_CASE("every voxel type has the same window for the same values", "[window]") {
  const Window expected = window_of(VoxelType::kF32, image_of<float>(block), 60, true);
  const auto check = [&](const Window& w) {
    CHECK(w.low == expected.low);
    CHECK(w.high == expected.high);
    CHECK(w.background == expected.background);
  };
  check(window_of(VoxelType::kU8, image_of<uint8_t>(block), 60, true));
  check(window_of(VoxelType::kI16, image_of<int16_t>(block), 60, true));
  check(window_of(VoxelType::kU16, image_of<uint16_t>(block), 60, true));
  check(window_of(VoxelType::kI32, image_of<int32_t>(block), 60, true));
}

TEST_CASE("the window is the same for any executor", "[window]") {
  const auto voxels = fixtures::random_floats(kSide * kSide * kSide, -500, 3000, 5);
  const Window one = window_of(VoxelType::kF32, voxels, 700, true);
  const Window other = window_of(VoxelType::kF32, voxels, 700, true, fixtures::ThreadExecutor(3));
  CHECK(one.low == other.low);
  CHECK(one.high == other.high);
  CHECK(one.background == other.background);
}

TEST_CASE("a surface at the border of the image counts where it has both sides", "[window]") {
  // The object fills the lower half up to the borders.
  const auto voxels =
      image_of<uint8_t>([](int64_t, int64_t, int64_t z) { return z < kSide / 2 ? 180.0 : 20.0; });
  const Window window = window_of(VoxelType::kU8, voxels, 100, true);
  CHECK(window.background == Approx(20).margin(0.1));
  CHECK(window.low == 20);
  CHECK(window.high == 180);
}
