// The bits of the kernels, written down: they may change only on purpose.
#include "kernels/scalar.h"

#include <bit>
#include <catch2/catch.hpp>

#include "kernel_fixtures.h"
#include "kernels/guided_stage.h"
#include "kernels/image_force.h"
#include "kernels/integrate.h"
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
  const auto all = plc::Blocks::range(0, n);
  kernels::laplacian(simd, view, position, all, laplacian.data());
  kernels::curvature_force(simd, view, laplacian.data(), 0.3F, 0, n, fx, fy, fz);
  kernels::spring_force(simd, view, position, 0.01F, 1.7F, {}, 0, n, fx, fy, fz);
  kernels::normals(simd, view, position, all, nx, ny, nz);
  kernels::iso_force(simd, image_view, position, nx, ny, nz, -1.2F, 0.4F, 0, n, fx, fy, fz);
  Hash hash;
  hash.add(flatten(laplacian));
  for (int a = 0; a < 3; ++a) {
    hash.add(force[a]);
    hash.add(normal[a]);
  }
  hash.add(kernels::edge_length_sum(simd, view, position, {}, 0, n));
  return hash.value();
}

// Streams of a step under random forces: four stages and the move.
uint64_t hash_of_motion(SimdTarget simd, bool guided) {
  const RandomRings rings = mixed_rings(32, 13);
  const uint32_t n = rings.count();
  const auto all = plc::Blocks::range(0, n);
  std::vector<std::vector<float>> s;
  for (uint32_t i = 0; i < 18; ++i) s.push_back(random_floats(n, -2, 2, 20 + i));
  const auto three = [&](size_t i) {
    return kernels::Float3s{s[i].data(), s[i + 1].data(), s[i + 2].data()};
  };
  const auto fixed = [&](size_t i) {
    return kernels::ConstFloat3s{s[i].data(), s[i + 1].data(), s[i + 2].data()};
  };
  const std::vector<float> image = random_floats(size_t{60} * 50 * 40, 0, 1, 14);
  std::vector<Packed> laplacian(n), stage(n), moved_to(n);
  std::vector<float> path(n);
  const kernels::Rk4Streams streams{rings.position.data(), fixed(0), three(6), three(9), three(12),
                                    stage.data()};
  const kernels::SurfaceForces forces{rings.view(),
                                      laplacian.data(),
                                      0.3F,
                                      {image.data(), {60, 50, 40}, {0.2F, 0.2F, 0.2F}, {3, 4, 5}},
                                      rings.position.data(),
                                      fixed(15),
                                      -1.2F,
                                      0.4F};
  const kernels::Rk4Coefficients newton{1.3F, 0.45F, 0.7F};
  const kernels::MoveBound bound{0.8F, 1.1F};
  const kernels::MoveStreams ends{rings.position.data(), moved_to.data(), three(0), fixed(15),
                                  path.data()};
  kernels::laplacian(simd, rings.view(), rings.position.data(), all, laplacian.data());
  Hash hash;
  for (int k = 0; k < (guided ? 3 : 4); ++k) {
    if (guided) {
      kernels::guided_stage(simd, k, newton, forces, streams, all);
    } else {
      kernels::rk4_stage(simd, k, newton, streams, fixed(3), all);
    }
    hash.add(flatten(stage));
  }
  hash.add(kernels::max_squared(simd, fixed(9), all));
  const kernels::Movement movement =
      guided ? kernels::guided_move(simd, newton, forces, streams, bound, ends, all)
             : kernels::move(simd, bound, three(9), fixed(12), ends, all);
  hash.add(movement.energy);
  hash.add(movement.longest2);
  for (const std::vector<float>& stream : s) hash.add(stream);
  hash.add(flatten(moved_to));
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
    CHECK(hash_of_forces(simd) == 0x987e158e1070282U);
    CHECK(hash_of_motion(simd, false) == 0x52461bd6e6465b8aU);
    CHECK(hash_of_motion(simd, true) == 0x9ba9697972e88260U);
    CHECK(hash_of_pyramid(simd) == 0x8ed4e9b4a18b3810U);
  }
}
