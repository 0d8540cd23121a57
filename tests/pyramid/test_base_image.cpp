#include "pyramid/base_image.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>

#include "kernels/image_value.h"
#include "pyramid/pyramid.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::SimdTarget;
using plc::VolumeView;
using plc::VoxelType;

}  // namespace

TEST_CASE("the base image is the volume in a border of the pad value", "[pyramid]") {
  const int64_t m = 7, n = 4, p = 3;
  std::vector<int16_t> voxels(static_cast<size_t>(m * n * p));
  for (size_t i = 0; i < voxels.size(); ++i) voxels[i] = static_cast<int16_t>(10 * i);
  const VolumeView volume{VoxelType::kI16, voxels.data(), {m, n, p}, {1, 1, 1}};
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const plc::SerialExecutor serial(simd);
    const ThreadExecutor threads(4, simd);
    for (const int64_t pad : {0, 1, 3}) {
      const int64_t rows = n + 2 * pad, columns = m + 2 * pad, planes = p + 2 * pad;
      std::vector<float> got(static_cast<size_t>(rows * columns * planes), kUntouched);
      std::vector<float> threaded = got;
      plc::make_base_image(volume, {100.0, 500.0}, pad, 200.0, serial, got.data());
      plc::make_base_image(volume, {100.0, 500.0}, pad, 200.0, threads, threaded.data());
      REQUIRE(first_difference(got, threaded) == -1);
      for (int64_t z = 0; z < planes; ++z) {
        for (int64_t y = 0; y < rows; ++y) {
          for (int64_t x = 0; x < columns; ++x) {
            const int64_t i = x - pad, j = y - pad, k = z - pad;
            const bool inside = i >= 0 && i < m && j >= 0 && j < n && k >= 0 && k < p;
            const double voxel = inside ? 10.0 * static_cast<double>(i + m * (j + n * k)) : 200.0;
            const double expected = std::min(std::max((voxel - 100.0) / 400.0, 0.0), 1.0);
            CAPTURE(pad, x, y, z);
            REQUIRE(double{got[static_cast<size_t>(x + columns * (y + rows * z))]} ==
                    Approx(expected).margin(3e-7));
          }
        }
      }
    }
  }
}

TEST_CASE("a voxel's value is itself on I_0, copied or borrowed, in every type", "[pyramid]") {
  std::vector<int16_t> voxels;
  for (int i = 0; i < 65536; ++i) voxels.push_back(static_cast<int16_t>(i - 32768));
  const std::vector<int32_t> integers(voxels.begin(), voxels.end());
  const VolumeView volume{VoxelType::kI16, voxels.data(), {16, 16, 256}, {1, 1, 1}};
  const VolumeView wide{VoxelType::kI32, integers.data(), {16, 16, 256}, {1, 1, 1}};
  const plc::Window window{-105.506348, 1418.877197};
  const plc::VoxelForm form = plc::borrowed_form(volume, window, 0, 0);
  REQUIRE(form.type == plc::ImageType::kI16);
  REQUIRE(plc::borrowed_form(wide, window, 0, 0).type == plc::ImageType::kUnit);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const plc::SerialExecutor serial(simd);
    std::vector<float> copy(voxels.size()), other(voxels.size());
    plc::make_base_image(volume, window, 0, 0, serial, copy.data());
    plc::make_base_image(wide, window, 0, 0, serial, other.data());
    REQUIRE(first_difference(copy, other) == -1);
    for (size_t i = 0; i < voxels.size(); ++i) {
      const float value = plc::voxel_value(form, voxels[i]);
      if (copy[i] != value || plc::window_value(volume, window, voxels[i]) != value) {
        FAIL(voxels[i]);
      }
    }
  }
}

TEST_CASE("the range of a volume of several parts is that of all its finite voxels", "[pyramid]") {
  // More than one task's worth, with one part that has no finite voxel at all.
  const int64_t part = int64_t{1} << 18;
  std::vector<float> voxels(static_cast<size_t>(part * 3), 4.0F);
  std::fill(voxels.begin() + part, voxels.begin() + 2 * part, std::nanf(""));
  voxels[3] = 2.5F;
  voxels[static_cast<size_t>(3 * part - 1)] = 11.0F;
  const VolumeView volume{VoxelType::kF32, voxels.data(), {part, 3, 1}, {1, 1, 1}};
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const plc::SerialExecutor serial(simd);
    const ThreadExecutor threads(3, simd);
    for (const plc::Executor* executor : {static_cast<const plc::Executor*>(&serial),
                                          static_cast<const plc::Executor*>(&threads)}) {
      const plc::VoxelRange range = plc::voxel_range(volume, *executor);
      REQUIRE(range.low == 2.5);
      REQUIRE(range.high == 11.0);
      REQUIRE(range.not_finite == part);
    }
  }
}
