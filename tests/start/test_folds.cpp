#include "engine/start/folds.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "engine/base/constants.h"
#include "engine/base/schedule.h"
#include "engine/start/iso_surface.h"
#include "tests/samples/sample_volumes.h"

namespace {

constexpr int32_t kSide = 32;
constexpr size_t kPlane = size_t{kSide} * kSide;

// A disc across z of radius 12, with a hole of radius 5 in the middle: `thick` slices from z = 16
// on, of the value 0.6 where iso is 0.5. A sixth of a voxel lies on both sides of the first and the
// last.
struct Disc {
  explicit Disc(int32_t thick, double noise = 0) : values(kPlane * kSide, 0) {
    for (int32_t z = 16; z < 16 + thick; ++z) {
      for (int32_t y = 0; y < kSide; ++y) {
        for (int32_t x = 0; x < kSide; ++x) {
          const double r = from_middle({x, y, z});
          if (r < 5 || r > 12) continue;
          values[static_cast<size_t>(z) * kPlane + static_cast<size_t>(y * kSide + x)] = 0.6F;
        }
      }
    }
    samples::Random random(3);
    for (float& v : values) v += static_cast<float>(random.uniform(-noise, noise));
    sizing.object = {{values.data(), {kSide, kSide, kSide}, {1, 1, 1}, {0, 0, 0}, {}}, 0.5F, true};
    sizing.full_image = true;
    const plc::SizeSpec spec;
    REQUIRE(sizing.field.build(sizing.object.image, 0.5F, 1, spec, plc::SerialExecutor()).ok());
    mesh.delta = 1;
    mesh.sizing = &sizing;
  }

  static double from_middle(const plc::Voxel& v) { return std::hypot(v[0] - 15.5, v[1] - 15.5); }

  std::vector<plc::Voxel> folds(int threads) const {
    const plc::Schedule schedule(threads);
    plc::Crossings crossings;
    REQUIRE(plc::iso_crossings(sizing.object, plc::values_of(sizing.object), 0, schedule, crossings)
                .ok());
    const plc::HalfEdges surface(std::move(crossings.abc), crossings.xyz.size() / 3, schedule);
    plc::VoxelSet set;
    const bool any = plc::find_folds(mesh, surface, crossings.xyz, schedule, set);
    std::vector<plc::Voxel> found;
    if (set.has_image()) set.visit([&](const plc::Voxel& v) { found.push_back(v); });
    CHECK(any == !found.empty());
    return found;
  }

  std::vector<float> values;
  plc::Sizing sizing;
  plc::Mesh mesh;
};

}  // namespace

TEST_CASE("of a thin disc the rims are folds to start with, and nothing between them", "[folds]") {
  const Disc disc(1);
  const auto found = disc.folds(1);
  size_t inner = 0, outer = 0;
  for (const plc::Voxel& v : found) {
    const double r = Disc::from_middle(v);
    CHECK((r < 6.5 || r > 10.5));
    (r < 8 ? inner : outer)++;
  }
  CHECK(inner > 10);
  CHECK(outer > 20);
  CHECK(disc.folds(2) == found);
}

TEST_CASE("what is thick, noisy or no full image has no folds to start with", "[folds]") {
  CHECK(Disc(4).folds(1).empty());
  const Disc noisy(1, 0.5);
  CHECK(noisy.sizing.field.noise() > plc::kThinNoise);
  CHECK(noisy.folds(1).empty());
  Disc coarse(1);
  coarse.sizing.full_image = false;
  CHECK(coarse.folds(1).empty());
}

TEST_CASE("late sizes are smaller where the full image is thin", "[folds]") {
  Disc disc(1);
  const plc::Voxel in_disc{24, 16, 16}, above{24, 16, 24};
  CHECK(plc::late_size(disc.mesh, in_disc) == plc::kThinSize);
  CHECK(plc::late_size(disc.mesh, above) == plc::kLateSize);
  disc.sizing.full_image = false;
  CHECK(plc::late_size(disc.mesh, in_disc) == plc::kLateSize);
}
