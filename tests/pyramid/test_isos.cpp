// covering_isos() of pyramid/pyramid.h.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "pyramid/pyramid.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/sample_levels.h"

namespace {

using fixtures::ThreadExecutor;
using plc::Pyramid;
using plc::PyramidLevel;
using plc::PyramidSpec;
using plc::VoxelType;

const plc::SerialExecutor kSerial;

// A pyramid with the voxels that it borrows.
struct Built {
  std::vector<float> voxels;
  Pyramid pyramid;
};

// value(x, y, z) in [0,1] on a cube of `size` voxels, no padding.
template <typename Value>
Built build(int64_t size, int levels, const Value& value) {
  Built built;
  std::vector<float>& voxels = built.voxels;
  for (int64_t z = 0; z < size; ++z) {
    for (int64_t y = 0; y < size; ++y) {
      for (int64_t x = 0; x < size; ++x) {
        voxels.push_back(static_cast<float>(
            value(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z))));
      }
    }
  }
  PyramidSpec spec;
  spec.levels = levels;
  spec.pad_voxels = 0;
  REQUIRE(plc::build_pyramid({VoxelType::kF32, voxels.data(), {size, size, size}, {1, 1, 1.5}},
                             spec, kSerial, built.pyramid)
              .ok());
  return built;
}

std::vector<double> isos_of(const Pyramid& pyramid, double iso_0, bool above) {
  return plc::covering_isos(pyramid, iso_0, above, above ? 0.0 : 1.0, kSerial);
}

// 1 inside the radius, 0 outside, linear over one voxel between; off the symmetries of the grid.
double ball(double x, double y, double z, double centre, double radius) {
  const double distance = std::hypot(x - centre, y - centre - 0.37, z - centre + 0.23);
  return std::clamp(radius - distance + 0.5, 0.0, 1.0);
}

// The level's value at the centre of a voxel of I_0: trilinear, by (10).
double seen_at(const PyramidLevel& base, const PyramidLevel& level, const int64_t (&voxel)[3]) {
  int64_t cell[3];
  double fraction[3];
  for (size_t a = 0; a < 3; ++a) {
    const double place =
        (static_cast<double>(voxel[a]) + 0.5) * base.voxel[a] / level.voxel[a] - 0.5;
    const double c = std::clamp(place, 0.0, static_cast<double>(level.dims[a] - 1));
    cell[a] = std::min(static_cast<int64_t>(c), level.dims[a] - 2);
    fraction[a] = c - static_cast<double>(cell[a]);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int64_t at[3];
    for (int a = 0; a < 3; ++a) {
      const int64_t up = corner >> a & 1;
      weight *= up == 1 ? fraction[a] : 1.0 - fraction[a];
      at[a] = cell[a] + up;
    }
    sum += weight * double{level.values[static_cast<size_t>(
                        at[0] + level.dims[0] * (at[1] + level.dims[1] * at[2]))]};
  }
  return sum;
}

// The part of the object of I_0 whose voxel centres the level's object holds.
double covered_part(const Pyramid& pyramid, size_t h, double iso_0, double iso, bool above) {
  const PyramidLevel& base = pyramid.levels[0];
  const std::vector<float> values = samples::values_of(base);
  int64_t object = 0, covered = 0;
  size_t i = 0;
  for (int64_t z = 0; z < base.dims[2]; ++z) {
    for (int64_t y = 0; y < base.dims[1]; ++y) {
      for (int64_t x = 0; x < base.dims[0]; ++x, ++i) {
        const double own = double{values[i]};
        if (above ? own < iso_0 : own > iso_0) continue;
        const double seen = seen_at(base, pyramid.levels[h], {x, y, z});
        ++object;
        covered += (above ? seen >= iso : seen <= iso) ? 1 : 0;
      }
    }
  }
  return static_cast<double>(covered) / static_cast<double>(object);
}

}  // namespace

TEST_CASE("a thin object stays in sight of all but a small part on every level", "[pyramid]") {
  const Built pyramid = build(60, 2, [](double x, double y, double z) {
    return ball(x, y, z, 29.5, 22) * (1.0 - ball(x, y, z, 29.5, 20.5)) * 0.9;
  });
  const double iso_0 = 0.45;
  const std::vector<double> isos = isos_of(pyramid.pyramid, iso_0, true);
  REQUIRE(isos.size() == 3);
  REQUIRE(isos[0] == iso_0);
  REQUIRE(isos[1] < 0.40);
  REQUIRE(isos[2] < isos[1]);
  for (size_t h = 1; h < 3; ++h) {
    CAPTURE(h, isos[h]);
    REQUIRE(covered_part(pyramid.pyramid, h, iso_0, isos[h], true) ==
            Approx(1.0 - plc::kUncoveredPart).margin(0.002));
    REQUIRE(covered_part(pyramid.pyramid, h, iso_0, iso_0, true) < 0.9);
  }
}

TEST_CASE("a dark object stays in sight as a bright one does", "[pyramid]") {
  const auto bright = [](double x, double y, double z) { return ball(x, y, z, 24, 3) * 0.8 + 0.1; };
  const Built above = build(48, 2, bright);
  const Built below =
      build(48, 2, [&](double x, double y, double z) { return 1.0 - bright(x, y, z); });
  const std::vector<double> isos = isos_of(above.pyramid, 0.4, true);
  const std::vector<double> dark = isos_of(below.pyramid, 0.6, false);
  REQUIRE(dark[0] == 0.6);
  for (size_t h = 1; h < isos.size(); ++h) {
    REQUIRE(isos[h] < 0.4);
    REQUIRE(dark[h] == Approx(1.0 - isos[h]).margin(1e-3));
  }
}

TEST_CASE("an object that a level shows anyway keeps its iso value", "[pyramid]") {
  // The whole object of I_0 lies deep inside of what is brighter than the value.
  const Built pyramid = build(40, 1, [](double x, double y, double z) {
    return 1.0 - std::hypot(x - 19.5, y - 19.5, z - 19.5) / 50.0;
  });
  Pyramid brighter = pyramid.pyramid;
  for (float& v : brighter.levels[1].values) v = std::min(1.0F, v + 0.1F);
  REQUIRE(isos_of(brighter, 0.7, true) == std::vector<double>{0.7, 0.7});
}

TEST_CASE("an image without the object leaves the iso value alone", "[pyramid]") {
  const Built dim = build(24, 2, [](double x, double, double) { return x / 100; });
  REQUIRE(isos_of(dim.pyramid, 0.5, true) == std::vector<double>{0.5, 0.5, 0.5});
  const Built bright = build(24, 2, [](double x, double, double) { return 0.7 + x / 100; });
  REQUIRE(isos_of(bright.pyramid, 0.5, false) == std::vector<double>{0.5, 0.5, 0.5});
  REQUIRE(isos_of(Pyramid{}, 0.5, true).empty());
}

TEST_CASE("iso values stay strictly between zero and one even where all has faded", "[pyramid]") {
  Pyramid pyramid;
  pyramid.levels.resize(2);
  for (PyramidLevel& level : pyramid.levels) {
    level.dims = {4, 4, 4};
    level.voxel = {1, 1, 1};
    level.values.resize(64);
  }
  pyramid.levels[0].values[21] = 1.0F;
  const std::vector<double> bright = isos_of(pyramid, 0.5, true);
  for (PyramidLevel& level : pyramid.levels) {
    for (float& v : level.values) v = 1.0F - v;
  }
  const std::vector<double> dark = isos_of(pyramid, 0.5, false);
  for (const double iso : {bright[1], dark[1]}) {
    REQUIRE(static_cast<float>(iso) > 0.0F);
    REQUIRE(static_cast<float>(iso) < 1.0F);
  }
  REQUIRE(bright[1] < 0.01);
  REQUIRE(dark[1] > 0.99);
}

TEST_CASE("iso values do not depend on the target or the threads", "[pyramid]") {
  const Built pyramid = build(44, 2, [](double x, double y, double z) {
    return ball(x, y, z, 20, 9) * (0.6 + 0.4 * std::sin(x * y + z));
  });
  const std::vector<double> expected = plc::covering_isos(
      pyramid.pyramid, 0.5, true, 0.0, plc::SerialExecutor(plc::SimdTarget::kScalar));
  for (const plc::SimdTarget simd : plc::available_simd_targets()) {
    for (const unsigned threads : {1U, 4U}) {
      REQUIRE(plc::covering_isos(pyramid.pyramid, 0.5, true, 0.0, ThreadExecutor(threads, simd)) ==
              expected);
    }
  }
}

TEST_CASE("no iso value of a level goes beyond the bound", "[pyramid]") {
  // A thin shell that all but fades away on the coarsest level.
  const Built pyramid = build(72, 3, [](double x, double y, double z) {
    return ball(x, y, z, 35.5, 28) * (1.0 - ball(x, y, z, 35.5, 26.5)) * 0.9;
  });
  const auto isos = [&](double bound) {
    return plc::covering_isos(pyramid.pyramid, 0.45, true, bound, kSerial);
  };
  REQUIRE(isos(0.0).back() < 0.3);
  REQUIRE(isos(0.3).back() == 0.3);
}
