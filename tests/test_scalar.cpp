// The bits of the kernels, written down: they may change only on purpose.
#include "kernels/scalar.h"

#include <bit>
#include <catch2/catch.hpp>

#include "kernel_fixtures.h"
#include "kernels/image_force.h"
#include "kernels/ring_forces.h"
#include "pyramid/pyramid.h"
#include "sample_levels.h"

namespace {

using namespace fixtures;
using plc::Packed;
using plc::SimdTarget;
namespace kernels = plc::kernels;

// FNV-1a over the bits of floats.
class Hash {
 public:
  void add(float value) {
    for (uint32_t bits = std::bit_cast<uint32_t>(value), i = 0; i < 4; ++i, bits >>= 8) {
      hash_ = (hash_ ^ (bits & 0xFFU)) * 0x100000001B3U;
    }
  }
  void add(const std::vector<float>& values) {
    for (const float v : values) add(v);
  }
  void add(double value) {
    add(static_cast<float>(value));
    add(static_cast<float>(value - double{static_cast<float>(value)}));
  }
  uint64_t value() const { return hash_; }

 private:
  uint64_t hash_ = 0xCBF29CE484222325U;
};

uint64_t hash_of_forces(SimdTarget simd) {
  const RandomRings rings = mixed_rings(64, 11);
  const uint32_t n = rings.count();
  std::vector<Packed> laplacian(n);
  std::vector<float> force[3], normal[3];
  for (int a = 0; a < 3; ++a) force[a] = normal[a] = std::vector<float>(n);
  const auto streams = [](std::vector<float>(&s)[3]) {
    return std::array<float*, 3>{s[0].data(), s[1].data(), s[2].data()};
  };
  const auto [fx, fy, fz] = streams(force);
  const auto [nx, ny, nz] = streams(normal);
  const plc::RingView view = rings.view();
  const Packed* position = rings.position.data();
  const std::vector<float> image = random_floats(size_t{60} * 50 * 40, 0, 1, 12);
  const plc::ImageView image_view{image.data(), {60, 50, 40}, {0.2F, 0.2F, 0.2F}, {3, 4, 5}};
  kernels::laplacian(simd, view, position, 0, n, laplacian.data());
  kernels::curvature_force(simd, view, laplacian.data(), 0.3F, 0, n, fx, fy, fz);
  kernels::spring_force(simd, view, position, 0.01F, 1.7F, {}, 0, n, fx, fy, fz);
  kernels::normals(simd, view, position, 0, n, nx, ny, nz);
  kernels::iso_force(simd, image_view, position, nx, ny, nz, -1.2F, 0.4F, 0, n, fx, fy, fz);
  Hash hash;
  hash.add(flatten(laplacian));
  for (int a = 0; a < 3; ++a) {
    hash.add(force[a]);
    hash.add(normal[a]);
  }
  hash.add(kernels::edge_length_sum(simd, view, position, {}, 0, n));
  hash.add(kernels::normal_energy_sum(simd, fx, fy, fz, nx, ny, nz, 0, n));
  return hash.value();
}

uint64_t hash_of_motion(SimdTarget simd) {
  const uint32_t n = 512;
  std::vector<std::vector<float>> s;
  for (uint32_t i = 0; i < 18; ++i) s.push_back(random_floats(n, -2, 2, 20 + i));
  std::vector<Packed> stage(n);
  std::vector<float> path(n);
  const auto at = [&](size_t i) { return s[i].data(); };
  const kernels::Rk4Streams streams{at(0),  at(1),  at(2),  at(3),  at(4),       at(5),  at(6),
                                    at(7),  at(8),  at(9),  at(10), at(11),      at(12), at(13),
                                    at(14), at(15), at(16), at(17), stage.data()};
  Hash hash;
  for (int k = 0; k < 4; ++k) {
    kernels::rk4_stage(simd, k, {1.3F, 0.45F, 0.7F}, streams, 0, n);
    hash.add(flatten(stage));
  }
  hash.add(kernels::max_squared(simd, at(12), at(13), at(14), 0, n));
  kernels::clamp_movement(simd, 0.8F, 1.1F, at(12), at(13), at(14), at(15), at(16), at(17), 0, n);
  kernels::move(simd, at(12), at(13), at(14), at(0), at(1), at(2), stage.data(), path.data(), 0, n);
  for (const std::vector<float>& stream : s) hash.add(stream);
  hash.add(flatten(stage));
  hash.add(path);
  return hash.value();
}

uint64_t hash_of_pyramid(SimdTarget simd) {
  const std::vector<float> voxels = random_floats(size_t{41} * 37 * 29, -100, 900, 31);
  plc::PyramidSpec spec;
  spec.levels = 2;
  spec.window_high = 700;
  spec.pad_voxels = 2;
  plc::Pyramid pyramid;
  REQUIRE(plc::build_pyramid({plc::VoxelType::kF32, voxels.data(), {41, 37, 29}, {1, 0.9, 1.7}},
                             spec, plc::SerialExecutor(), simd, pyramid)
              .ok());
  Hash hash;
  for (const plc::PyramidLevel& level : pyramid.levels) {
    hash.add(samples::values_of(level));
  }
  return hash.value();
}

}  // namespace

TEST_CASE("forces, motion and pyramids have the recorded bits on every target", "[kernels]") {
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    CHECK(hash_of_forces(simd) == 0xf5cf747d92ae23fcU);
    CHECK(hash_of_motion(simd) == 0xb6e477f8a4cfc2f3U);
    CHECK(hash_of_pyramid(simd) == 0x8ed4e9b4a18b3810U);
  }
}
