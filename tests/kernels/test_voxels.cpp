#include "kernels/voxels.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <type_traits>

#include "kernels/scalar.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::SimdTarget;
using plc::VoxelType;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

template <typename T>
constexpr VoxelType voxel_type() {
  if (std::is_same_v<T, uint8_t>) return VoxelType::kU8;
  if (std::is_same_v<T, int16_t>) return VoxelType::kI16;
  if (std::is_same_v<T, uint16_t>) return VoxelType::kU16;
  if (std::is_same_v<T, int32_t>) return VoxelType::kI32;
  return VoxelType::kF32;
}

// Values over the whole range of the type, its extremes among them.
template <typename T>
std::vector<T> random_voxels(size_t count, uint32_t seed) {
  std::vector<T> voxels(count);
  std::mt19937 random(seed);
  if constexpr (std::is_floating_point_v<T>) {
    std::uniform_real_distribution<T> value(T(-1000), T(3000));
    for (T& v : voxels) v = value(random);
  } else {
    std::uniform_int_distribution<int64_t> value(std::numeric_limits<T>::min(),
                                                 std::numeric_limits<T>::max());
    for (T& v : voxels) v = static_cast<T>(value(random));
    if (count > 1) {
      voxels[count / 2] = std::numeric_limits<T>::max();
      voxels[count / 3] = std::numeric_limits<T>::min();
    }
  }
  return voxels;
}

}  // namespace

TEMPLATE_TEST_CASE("the window maps every voxel type to [0,1]", "[kernels]", uint8_t, int16_t,
                   uint16_t, int32_t, float) {
  const std::vector<TestType> voxels = random_voxels<TestType>(203, 1);
  const auto [least, most] = std::minmax_element(voxels.begin(), voxels.end());
  const double width = static_cast<double>(*most) - static_cast<double>(*least);
  const double low = static_cast<double>(*least) + 0.2 * width;
  const double scale = 1.0 / (0.5 * width);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (size_t count = 0; count <= voxels.size(); count += count < 40 ? 1 : 163) {
      CAPTURE(plc::simd_target_name(simd), count);
      std::vector<float> got(voxels.size(), kUntouched);
      std::vector<float> twin = got;
      kernels::normalize_voxels(simd, voxel_type<TestType>(), voxels.data(), count, low, scale,
                                got.data());
      scalar::normalize_voxels(voxel_type<TestType>(), voxels.data(), count, low, scale,
                               twin.data());
      REQUIRE(first_difference(got, twin) == -1);
      for (size_t i = 0; i < voxels.size(); ++i) {
        const double expected =
            std::clamp((static_cast<double>(voxels[i]) - low) / (0.5 * width), 0.0, 1.0);
        REQUIRE(double{got[i]} == Approx(i < count ? expected : double{kUntouched}).margin(1e-7));
      }
    }
  }
}

TEST_CASE("a voxel that is no number counts as the window's low end", "[kernels]") {
  const float inf = std::numeric_limits<float>::infinity();
  std::vector<float> voxels(21, 30.0F);
  voxels[2] = voxels[20] = std::nanf("");
  voxels[3] = inf;
  voxels[4] = -inf;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    std::vector<float> got(21);
    kernels::normalize_voxels(simd, VoxelType::kF32, voxels.data(), 21, 20.0, 0.05, got.data());
    REQUIRE(got[1] == 0.5F);
    REQUIRE(got[2] == 0.0F);
    REQUIRE(got[3] == 1.0F);
    REQUIRE(got[4] == 0.0F);
    REQUIRE(got[20] == 0.0F);
  }
}

TEST_CASE("32-bit voxels keep their differences far from zero", "[kernels]") {
  std::vector<int32_t> voxels(16);
  for (int32_t i = 0; i < 16; ++i) voxels[static_cast<size_t>(i)] = 2000000000 + i;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    std::vector<float> got(16);
    kernels::normalize_voxels(simd, VoxelType::kI32, voxels.data(), 16, 2e9, 1.0 / 16, got.data());
    for (int i = 0; i < 16; ++i) {
      REQUIRE(got[static_cast<size_t>(i)] == static_cast<float>(i) / 16.0F);
    }
  }
}

TEMPLATE_TEST_CASE("the extent is the smallest and the largest voxel", "[kernels]", uint8_t,
                   int16_t, uint16_t, int32_t, float) {
  const std::vector<TestType> voxels = random_voxels<TestType>(203, 2);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (size_t count = 1; count <= voxels.size(); ++count) {
      const auto [least, most] =
          std::minmax_element(voxels.begin(), voxels.begin() + static_cast<ptrdiff_t>(count));
      const kernels::VoxelExtent got =
          kernels::voxel_extent(simd, voxel_type<TestType>(), voxels.data(), count);
      CAPTURE(plc::simd_target_name(simd), count);
      REQUIRE(got.low == static_cast<double>(*least));
      REQUIRE(got.high == static_cast<double>(*most));
      REQUIRE(got.not_finite == 0);
    }
  }
}

TEST_CASE("the extent is that of the finite voxels and the others are counted", "[kernels]") {
  const float inf = std::numeric_limits<float>::infinity();
  const float nan = std::nanf("");
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    std::vector<float> voxels(67, 5.0F);
    voxels[0] = nan;
    voxels[8] = inf;
    voxels[33] = -inf;
    voxels[66] = nan;
    voxels[40] = -2.0F;
    voxels[65] = 9.0F;
    kernels::VoxelExtent got = kernels::voxel_extent(simd, VoxelType::kF32, voxels.data(), 67);
    REQUIRE(got.low == -2.0);
    REQUIRE(got.high == 9.0);
    REQUIRE(got.not_finite == 4);
    // Only the scalar tail, or only the vectors, have finite voxels.
    std::fill(voxels.begin(), voxels.begin() + 64, nan);
    got = kernels::voxel_extent(simd, VoxelType::kF32, voxels.data(), 67);
    REQUIRE(got.low == 5.0);
    REQUIRE(got.high == 9.0);
    REQUIRE(got.not_finite == 65);
    std::fill(voxels.begin(), voxels.begin() + 64, 3.0F);
    std::fill(voxels.begin() + 64, voxels.end(), inf);
    got = kernels::voxel_extent(simd, VoxelType::kF32, voxels.data(), 67);
    REQUIRE(got.low == 3.0);
    REQUIRE(got.high == 3.0);
    std::fill(voxels.begin(), voxels.end(), nan);
    got = kernels::voxel_extent(simd, VoxelType::kF32, voxels.data(), 67);
    REQUIRE(got.low == 0.0);
    REQUIRE(got.high == 0.0);
    REQUIRE(got.not_finite == 67);
  }
}

TEST_CASE("an extent of zeros has no sign", "[kernels]") {
  std::vector<float> voxels(19, 0.0F);
  for (size_t i = 0; i < voxels.size(); i += 2) voxels[i] = -0.0F;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const kernels::VoxelExtent got =
        kernels::voxel_extent(simd, VoxelType::kF32, voxels.data(), 19);
    REQUIRE_FALSE(std::signbit(got.low));
    REQUIRE_FALSE(std::signbit(got.high));
  }
}
