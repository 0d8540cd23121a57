// volume_preserving_isos() of pyramid/pyramid.h.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "kernel_fixtures.h"
#include "pyramid/pyramid.h"

namespace {

using plc::Pyramid;
using plc::PyramidSpec;
using plc::VoxelType;

const plc::SerialExecutor kSerial;

// value(x, y, z) in [0,1] on a cube of `size` voxels, no padding.
template <typename Value>
Pyramid build(int64_t size, int levels, const Value& value) {
  std::vector<float> voxels;
  for (int64_t z = 0; z < size; ++z) {
    for (int64_t y = 0; y < size; ++y) {
      for (int64_t x = 0; x < size; ++x) {
        voxels.push_back(static_cast<float>(
            value(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z))));
      }
    }
  }
  Pyramid pyramid;
  PyramidSpec spec;
  spec.levels = levels;
  spec.pad_voxels = 0;
  REQUIRE(plc::build_pyramid({VoxelType::kF32, voxels.data(), {size, size, size}, {1, 1, 1}}, spec,
                             kSerial, plc::best_simd_target(), pyramid)
              .ok());
  return pyramid;
}

// Off the symmetries of the grid, so that no two voxels have the same value.
double ball(double x, double y, double z, double centre, double radius) {
  const double distance = std::hypot(x - centre, y - centre - 0.37, z - centre + 0.23);
  return std::clamp(radius - distance + 0.5, 0.0, 1.0);
}

double share_inside(const plc::PyramidLevel& level, double iso, bool above) {
  const auto inside = std::count_if(level.values.begin(), level.values.end(), [&](float v) {
    return above ? double{v} >= iso : double{v} <= iso;
  });
  return static_cast<double>(inside) / static_cast<double>(level.values.size());
}

}  // namespace

TEST_CASE("on every level the object keeps the volume it has on I_0", "[pyramid]") {
  // A thin shell: on coarse levels it fades, so its iso value has to come down.
  const Pyramid pyramid = build(72, 2, [](double x, double y, double z) {
    return ball(x, y, z, 35.5, 28) * (1.0 - ball(x, y, z, 35.5, 26.5)) * 0.9;
  });
  const double iso_0 = 0.45;
  const std::vector<double> isos = plc::volume_preserving_isos(pyramid, iso_0, true);
  REQUIRE(isos.size() == 3);
  REQUIRE(isos[0] == iso_0);
  REQUIRE(isos[1] < 0.40);
  REQUIRE(isos[2] < isos[1]);
  const double share = share_inside(pyramid.levels[0], iso_0, true);
  for (size_t h = 1; h < 3; ++h) {
    const auto voxels = static_cast<double>(pyramid.levels[h].values.size());
    REQUIRE(share_inside(pyramid.levels[h], isos[h], true) == Approx(share).margin(2.0 / voxels));
  }
}

TEST_CASE("a dark object keeps its volume as a bright one does", "[pyramid]") {
  const auto bright = [](double x, double y, double z) { return ball(x, y, z, 30, 9) * 0.8 + 0.1; };
  const Pyramid above = build(64, 3, bright);
  const Pyramid below =
      build(64, 3, [&](double x, double y, double z) { return 1.0 - bright(x, y, z); });
  const std::vector<double> isos = plc::volume_preserving_isos(above, 0.4, true);
  const std::vector<double> dark = plc::volume_preserving_isos(below, 0.6, false);
  REQUIRE(dark[0] == 0.6);
  for (size_t h = 1; h < isos.size(); ++h) {
    REQUIRE(isos[h] != 0.4);
    REQUIRE(dark[h] == Approx(1.0 - isos[h]).margin(1e-4));
  }
}

TEST_CASE("between the two values of a mask the iso value stays where it was", "[pyramid]") {
  // Half of the voxels are set, and the smoothing of the flat border leaves that so.
  const Pyramid pyramid = build(32, 2, [](double x, double, double) { return x < 16 ? 0.0 : 1.0; });
  for (const double iso_0 : {0.5, 0.45, 0.55}) {
    for (const double iso : plc::volume_preserving_isos(pyramid, iso_0, true)) {
      REQUIRE(iso == Approx(iso_0).margin(0.2));
    }
  }
  Pyramid masks;
  masks.levels.resize(2);
  for (plc::PyramidLevel& level : masks.levels) {
    level.dims = {4, 4, 4};
    level.values.resize(64);
    for (size_t i = 0; i < 20; ++i) level.values[3 * i] = 1.0F;
  }
  REQUIRE(plc::volume_preserving_isos(masks, 0.3, true) == std::vector<double>{0.3, 0.3});
  REQUIRE(plc::volume_preserving_isos(masks, 0.7, false) == std::vector<double>{0.7, 0.7});
}

TEST_CASE("an object that fades away altogether is looked for at the brightest voxels",
          "[pyramid]") {
  const Pyramid pyramid = build(64, 3, [](double x, double y, double z) {
    return x == 32 && y == 32 && z == 32 ? 1.0 : 0.0;
  });
  const std::vector<double> isos = plc::volume_preserving_isos(pyramid, 0.5, true);
  for (size_t h = 1; h < isos.size(); ++h) {
    const auto& values = pyramid.levels[h].values;
    const double brightest = double{*std::max_element(values.begin(), values.end())};
    REQUIRE(brightest < 0.5);
    REQUIRE(isos[h] > 0.0);
    REQUIRE(isos[h] <= brightest + 1.0 / 65536);
    REQUIRE(isos[h] > 0.4 * brightest);
  }
}

TEST_CASE("an image without the object, or of one value, leaves the iso value alone", "[pyramid]") {
  const Pyramid dim = build(24, 2, [](double x, double, double) { return x / 100; });
  REQUIRE(plc::volume_preserving_isos(dim, 0.5, true) == std::vector<double>{0.5, 0.5, 0.5});
  REQUIRE(plc::volume_preserving_isos(dim, 0.5, false) == std::vector<double>{0.5, 0.5, 0.5});
  Pyramid faded;
  faded.levels.resize(2);
  for (plc::PyramidLevel& level : faded.levels) {
    level.dims = {4, 4, 4};
    level.values.resize(64);
  }
  faded.levels[0].values[5] = 1.0F;
  REQUIRE(plc::volume_preserving_isos(faded, 0.5, true) == std::vector<double>{0.5, 0.5});
  REQUIRE(plc::volume_preserving_isos(Pyramid{}, 0.5, true).empty());
}

TEST_CASE("iso values stay strictly between zero and one", "[pyramid]") {
  // Saturated: three quarters of I_0 are 1, but fewer of the coarse level.
  Pyramid pyramid;
  pyramid.levels.resize(2);
  for (plc::PyramidLevel& level : pyramid.levels) {
    level.dims = {4, 4, 4};
    level.values.resize(64);
    for (size_t i = 0; i < 48; ++i) level.values[i] = 1.0F;
  }
  for (size_t i = 0; i < 24; ++i) pyramid.levels[1].values[i] = 0.0F;
  for (const bool above : {true, false}) {
    for (const double iso_0 : {0.001, 0.5, 0.999}) {
      const std::vector<double> isos = plc::volume_preserving_isos(pyramid, iso_0, above);
      REQUIRE(isos[0] == iso_0);
      REQUIRE(isos[1] > 0.0);
      REQUIRE(isos[1] < 1.0);
      REQUIRE(static_cast<float>(isos[1]) > 0.0F);
      REQUIRE(static_cast<float>(isos[1]) < 1.0F);
    }
  }
}
