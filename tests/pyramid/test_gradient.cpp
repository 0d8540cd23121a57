#include "pyramid/gradient.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "kernels/gradient_force.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/limited_memory.h"
#include "tests/samples/sample_volumes.h"

namespace {

using namespace fixtures;
using plc::Buffer;
using plc::ErrorCode;
using plc::Float4;
using plc::PyramidLevel;
using plc::SimdTarget;
using plc::Status;
using Dims = std::array<int64_t, 3>;
using Vector = std::array<double, 3>;

const plc::SerialExecutor kSerial;

PyramidLevel level_of(const Dims& dims, const std::vector<float>& values) {
  PyramidLevel level;
  level.dims = dims;
  level.voxel = {1, 1, 1};
  level.unit = 1;
  level.values.resize(values.size());
  std::copy(values.begin(), values.end(), level.values.begin());
  return level;
}

PyramidLevel random_level(const Dims& dims, uint32_t seed) {
  return level_of(dims,
                  random_floats(static_cast<size_t>(dims[0] * dims[1] * dims[2]), 0, 1, seed));
}

template <typename Value>
PyramidLevel sampled_level(const Dims& dims, const Value& value) {
  std::vector<float> values;
  for (int64_t z = 0; z < dims[2]; ++z) {
    for (int64_t y = 0; y < dims[1]; ++y) {
      for (int64_t x = 0; x < dims[0]; ++x) {
        values.push_back(static_cast<float>(
            value(static_cast<double>(x), static_cast<double>(y), static_cast<double>(z))));
      }
    }
  }
  return level_of(dims, values);
}

std::vector<Float4> must_build(const PyramidLevel& level, const Vector& voxel_length, double bound,
                               const plc::Executor& executor) {
  Buffer<Float4> gradient;
  const Status status = plc::build_gradient(level, voxel_length, bound, executor, gradient);
  CAPTURE(status.message());
  REQUIRE(status.ok());
  REQUIRE(gradient.size() == level.values.size());
  return {gradient.begin(), gradient.end()};
}

// The bounded gradient of 3.8 by definition: 27 voxels, replicated borders; none at the border.
Vector expected_gradient(const PyramidLevel& level, const Vector& voxel_length, double bound,
                         const Dims& at) {
  const double difference[3] = {-0.5, 0, 0.5}, mean[3] = {0.25, 0.5, 0.25};
  Vector g{};
  for (size_t a = 0; a < 3; ++a) {
    if (at[a] == 0 || at[a] + 1 == level.dims[a]) return g;
  }
  for (int corner = 0; corner < 27; ++corner) {
    const int offset[3] = {corner % 3, corner / 3 % 3, corner / 9};
    int64_t v[3];
    for (size_t a = 0; a < 3; ++a) {
      v[a] = std::clamp<int64_t>(at[a] + offset[a] - 1, 0, level.dims[a] - 1);
    }
    const double value = double{
        level.values[static_cast<size_t>(v[0] + level.dims[0] * (v[1] + level.dims[1] * v[2]))]};
    for (int axis = 0; axis < 3; ++axis) {
      double weight = 1;
      for (int a = 0; a < 3; ++a) weight *= (a == axis ? difference : mean)[offset[a]];
      g[static_cast<size_t>(axis)] += weight * value / voxel_length[static_cast<size_t>(axis)];
    }
  }
  const double length = std::sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  for (double& c : g) c *= (length > bound ? bound / length : 1.0) / bound;
  return g;
}

void require_definition(const Dims& dims, const Vector& voxel_length, double bound) {
  const PyramidLevel level = random_level(dims, 11);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const std::vector<Float4> got =
        must_build(level, voxel_length, bound, plc::SerialExecutor(simd));
    size_t i = 0;
    for (int64_t z = 0; z < dims[2]; ++z) {
      for (int64_t y = 0; y < dims[1]; ++y) {
        for (int64_t x = 0; x < dims[0]; ++x, ++i) {
          const Vector expected = expected_gradient(level, voxel_length, bound, {x, y, z});
          CAPTURE(plc::simd_target_name(simd), bound, x, y, z);
          REQUIRE(double{got[i].x} == Approx(expected[0]).margin(2e-6));
          REQUIRE(double{got[i].y} == Approx(expected[1]).margin(2e-6));
          REQUIRE(double{got[i].z} == Approx(expected[2]).margin(2e-6));
          REQUIRE(got[i].w == 0.0F);
          REQUIRE(std::hypot(got[i].x, got[i].y, got[i].z) < 1.000001F);
        }
      }
    }
  }
}

Status build_status(const Vector& voxel_length, double bound) {
  const PyramidLevel level = random_level({3, 3, 3}, 1);
  Buffer<Float4> gradient(5);  // of an earlier use
  Status status = plc::build_gradient(level, voxel_length, bound,
                                      plc::SerialExecutor(SimdTarget::kScalar), gradient);
  if (!status.ok()) REQUIRE(gradient.empty());
  return status;
}

}  // namespace

TEST_CASE("the gradient of a level is Sobel's per unit, bounded, in parts of the bound",
          "[pyramid]") {
  for (const double bound : {0.05, 0.3, 10.0}) {
    require_definition({13, 9, 7}, {1.0, 1.0, 1.0}, bound);
    require_definition({17, 5, 3}, {1.0, 1.3, 2.7}, bound);
  }
  require_definition({2, 2, 2}, {1.0, 1.0, 1.0}, 0.2);
}

TEST_CASE("the gradient of a linear ramp is its slope per unit", "[pyramid]") {
  // Per voxel 1/64, -1/32, 1/16; voxels of 1, 2 and 4 units: slopes all of 1/64, bound 1/16.
  const PyramidLevel level = sampled_level(
      {11, 9, 7}, [](double x, double y, double z) { return 0.5 + x / 64 - y / 32 + z / 16; });
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const std::vector<Float4> got =
        must_build(level, {1, 2, 4}, 1.0 / 16, plc::SerialExecutor(simd));
    for (size_t z = 1; z < 6; ++z) {
      for (size_t y = 1; y < 8; ++y) {
        for (size_t x = 1; x < 10; ++x) {
          const Float4& g = got[x + 11 * (y + 9 * z)];
          REQUIRE(std::array<float, 3>{g.x, g.y, g.z} ==
                  std::array<float, 3>{0.25F, -0.25F, 0.25F});
        }
      }
    }
    REQUIRE(got[11 * (4 + 9 * 3)].x == 0);
    REQUIRE(got[5 + 11 * (4 + 9 * 6)].z == 0);
  }
}

TEST_CASE("a steep ramp has length one in its own direction", "[pyramid]") {
  const PyramidLevel level =
      sampled_level({5, 5, 5}, [](double x, double y, double) { return (3 * x + 4 * y) / 28; });
  const Float4 g = must_build(level, {1, 1, 1}, 0.01, kSerial)[62];
  REQUIRE(g.x == Approx(0.6F));
  REQUIRE(g.y == Approx(0.8F));
  REQUIRE(g.z == Approx(0.0F).margin(1e-6));
}

TEST_CASE("the gradient has the same bits for every target and any number of threads",
          "[pyramid]") {
  const PyramidLevel level = random_level({45, 31, 29}, 3);
  const std::vector<float> expected =
      flatten(must_build(level, {1, 1.1, 2.3}, 0.2, plc::SerialExecutor(SimdTarget::kScalar)));
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const unsigned threads : {1U, 2U, 3U}) {
      CAPTURE(plc::simd_target_name(simd), threads);
      const std::vector<Float4> got =
          must_build(level, {1, 1.1, 2.3}, 0.2, ThreadExecutor(threads, simd));
      REQUIRE(first_difference(flatten(got), expected) == -1);
    }
  }
}

TEST_CASE("the gradient force draws vertices to the ridge of a shell from both sides",
          "[pyramid]") {
  // Brightest at radius 12 around (20, 20, 20).
  const PyramidLevel level = sampled_level({41, 41, 41}, [](double x, double y, double z) {
    return std::max(0.0, 1 - std::abs(samples::norm(x - 20, y - 20, z - 20) - 12) / 6);
  });
  const std::vector<Float4> gradient = must_build(level, {1, 1, 1}, 0.5, kSerial);
  plc::GradientView view{gradient.data(), {41, 41, 41}, {1, 1, 1}, {0, 0, 0}};
  const uint32_t count = 160;
  std::vector<float> n[3], f[3];
  for (uint32_t a = 0; a < 3; ++a) {
    n[a] = random_floats(count, -1, 1, 40 + a);
    f[a].assign(count, 0.0F);
  }
  std::vector<Float4> position(count);
  std::vector<float> radius(count);
  for (uint32_t i = 0; i < count; ++i) {
    const float length = std::hypot(n[0][i], n[1][i], n[2][i]);
    for (std::vector<float>& a : n) a[i] /= length;
    radius[i] = i % 2 == 0 ? 9.0F : 15.0F;
    position[i] = {20 + radius[i] * n[0][i], 20 + radius[i] * n[1][i], 20 + radius[i] * n[2][i], 0};
  }
  plc::kernels::gradient_force(plc::best_simd_target(), view, position.data(),
                               {n[0].data(), n[1].data(), n[2].data()}, {1, 1, {1, 1, 1}}, 0, count,
                               {f[0].data(), f[1].data(), f[2].data()});
  for (uint32_t i = 0; i < count; ++i) {
    const float outward = f[0][i] * n[0][i] + f[1][i] * n[1][i] + f[2][i] * n[2][i];
    const float slope = (1.0F / 6) / 0.5F;  // per voxel, in parts of the bound
    REQUIRE(outward == Approx(radius[i] < 12 ? slope : -slope).epsilon(0.05));
    REQUIRE(std::hypot(f[0][i], f[1][i], f[2][i]) < 1.05F * slope);
  }
}

TEST_CASE("a gradient without bound or with voxels of no length is refused", "[pyramid]") {
  REQUIRE(build_status({1, 1, 1}, 0.5).ok());
  REQUIRE(build_status({1, 1, 1}, 0.0).message() ==
          "gradient bound 0: expected a finite value greater than 0");
  REQUIRE(build_status({1, -2, 1.5}, 0.5).message() ==
          "gradient: voxel of 1 x -2 x 1.5 units: expected finite lengths greater than 0");
  const double inf = std::numeric_limits<double>::infinity();
  for (const double wrong : {0.0, -1.0, inf, std::nan("")}) {
    REQUIRE(build_status({1, 1, 1}, wrong).code() == ErrorCode::kInvalidArgument);
    for (size_t a = 0; a < 3; ++a) {
      Vector length{1, 1, 1};
      length[a] = wrong;
      REQUIRE(build_status(length, 0.5).code() == ErrorCode::kInvalidArgument);
    }
  }
}

TEST_CASE("a tiny or huge bound leaves no vector that is not finite", "[pyramid]") {
  PyramidLevel level = random_level({5, 4, 3}, 9);
  for (size_t i = 0; i < 20; ++i) level.values[i] = 0.5F;
  for (const double bound : {1e-300, 1e-30, 1e30, 1e300}) {
    for (const double length : {1e-300, 1.0, 1e300}) {
      const std::vector<Float4> got = must_build(level, {1, length, 1}, bound, kSerial);
      for (const float v : flatten(got)) REQUIRE(std::abs(v) < 1.000001F);
    }
  }
}

#if FIXTURES_CAN_LIMIT_MEMORY
TEST_CASE("a gradient beyond the memory is refused, not thrown", "[pyramid]") {
  PyramidLevel level = random_level({2, 2, 2}, 1);
  level.dims = {256, 256, 256};
  level.values.resize(size_t{1} << 24);
  Buffer<Float4> gradient;
  const MemoryLimit limit(size_t{64} << 20);  // it takes 256 MB
  const Status status =
      plc::build_gradient(level, {1, 1, 1}, 1, plc::SerialExecutor(SimdTarget::kScalar), gradient);
  REQUIRE(status.code() == ErrorCode::kOutOfMemory);
  REQUIRE(status.message() == "gradient of 256 x 256 x 256 voxels: out of memory");
  REQUIRE(gradient.empty());
}
#endif
