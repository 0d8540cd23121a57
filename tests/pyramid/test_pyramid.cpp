#include "pyramid/pyramid.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "pyramid/memory.h"
#include "tests/pyramid/reference_pyramid.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/limited_memory.h"
#include "tests/samples/sample_levels.h"

namespace {

using namespace fixtures;
using plc::ErrorCode;
using plc::Pyramid;
using plc::PyramidLevel;
using plc::PyramidSpec;
using plc::SimdTarget;
using plc::Status;
using plc::VolumeView;
using plc::VoxelType;
using Dims = std::array<int64_t, 3>;

const plc::SerialExecutor kSerial;
const double kSqrt3 = std::sqrt(3.0);

// Smooth blobs and noise in 0 .. 200.
template <typename T>
std::vector<T> make_voxels(const Dims& dims) {
  std::vector<T> voxels(static_cast<size_t>(dims[0] * dims[1] * dims[2]));
  std::mt19937 random(7);
  std::uniform_int_distribution<int> noise(0, 100);
  size_t i = 0;
  for (int64_t z = 0; z < dims[2]; ++z) {
    for (int64_t y = 0; y < dims[1]; ++y) {
      for (int64_t x = 0; x < dims[0]; ++x, ++i) {
        const double blob = 50.0 + 50.0 * std::sin(0.4 * static_cast<double>(x)) *
                                       std::cos(0.3 * static_cast<double>(y + z));
        voxels[i] = static_cast<T>(static_cast<int>(blob) + noise(random));
      }
    }
  }
  return voxels;
}

Pyramid must_build(const VolumeView& volume, const PyramidSpec& spec,
                   const plc::Executor& executor) {
  Pyramid pyramid;
  const Status status = plc::build_pyramid(volume, spec, executor, pyramid);
  CAPTURE(status.message());
  REQUIRE(status.ok());
  REQUIRE(pyramid.levels.size() == static_cast<size_t>(spec.levels) + 1);
  return pyramid;
}

// V_h at a point of real space: trilinear between the centres (10), borders replicated.
double real_image(const PyramidLevel& level, const std::vector<float>& values,
                  const std::array<double, 3>& point) {
  int64_t cell[3];
  double fraction[3];
  for (size_t a = 0; a < 3; ++a) {
    const double c = point[a] / level.voxel[a] - 0.5;
    cell[a] = static_cast<int64_t>(std::floor(c));
    fraction[a] = c - std::floor(c);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int64_t at[3];
    for (int a = 0; a < 3; ++a) {
      const int64_t up = corner >> a & 1;
      weight *= up == 1 ? fraction[a] : 1.0 - fraction[a];
      at[a] = std::clamp<int64_t>(cell[a] + up, 0, level.dims[static_cast<size_t>(a)] - 1);
    }
    sum +=
        weight *
        double{
            values[static_cast<size_t>(at[0] + level.dims[0] * (at[1] + level.dims[1] * at[2]))]};
  }
  return sum;
}

// Eq. (12) by its definition: 125 points, not separated.
double convolution(const PyramidLevel& from, const std::vector<float>& values,
                   const PyramidLevel& to, const Dims& voxel) {
  const double kernel[5] = {1, 4, 6, 4, 1};
  double sum = 0;
  for (int p = -2; p <= 2; ++p) {
    for (int n = -2; n <= 2; ++n) {
      for (int m = -2; m <= 2; ++m) {
        const int offset[3] = {m, n, p};
        std::array<double, 3> point{};
        for (size_t a = 0; a < 3; ++a) {
          point[a] = (static_cast<double>(voxel[a]) + 0.5) * to.voxel[a] + offset[a] * from.unit;
        }
        sum += kernel[m + 2] * kernel[n + 2] * kernel[p + 2] / 4096.0 *
               real_image(from, values, point);
      }
    }
  }
  return sum;
}

void require_definition(const PyramidLevel& from, const PyramidLevel& to) {
  const std::vector<float> values = samples::values_of(from);
  double worst = 0;
  size_t i = 0;
  for (int64_t z = 0; z < to.dims[2]; ++z) {
    for (int64_t y = 0; y < to.dims[1]; ++y) {
      for (int64_t x = 0; x < to.dims[0]; ++x, ++i) {
        worst = std::max(worst,
                         std::abs(double{to.values[i]} - convolution(from, values, to, {x, y, z})));
      }
    }
  }
  REQUIRE(worst < 5e-7);
}

Status build_status(const VolumeView& volume, const PyramidSpec& spec) {
  Pyramid pyramid;
  pyramid.levels.resize(5);  // of an earlier use
  Status status =
      plc::build_pyramid(volume, spec, plc::SerialExecutor(SimdTarget::kScalar), pyramid);
  if (!status.ok()) REQUIRE(pyramid.levels.empty());
  return status;
}

void require_refused(const Status& status, ErrorCode code, const std::string& message) {
  REQUIRE(status.message() == message);
  REQUIRE(status.code() == code);
}

}  // namespace

TEST_CASE("every level is the convolution (12) of the level below", "[pyramid]") {
  for (const double reduction : {1.25, kSqrt3, 2.0}) {
    for (const std::array<double, 3>& spacing :
         {std::array<double, 3>{1, 1, 1}, std::array<double, 3>{0.7, 1.1, 2.3}}) {
      const std::vector<int16_t> voxels = make_voxels<int16_t>({27, 23, 19});
      const VolumeView volume{VoxelType::kI16, voxels.data(), {27, 23, 19}, spacing};
      PyramidSpec spec;
      spec.reduction = reduction;
      spec.levels = 2;
      spec.window_high = 200;
      spec.pad_value = 130;
      spec.pad_voxels = 1;
      CAPTURE(reduction, spacing[2]);
      const Pyramid pyramid = must_build(volume, spec, kSerial);
      for (size_t h = 0; h < 2; ++h) require_definition(pyramid.levels[h], pyramid.levels[h + 1]);
    }
  }
}

TEST_CASE("the pyramid is (10) to (12) from the volume up, also on odd sizes of flat voxels",
          "[pyramid]") {
  const Dims dims{13, 27, 9};
  const std::array<double, 3> spacing{1.7, 0.4, 3.1};
  const std::vector<uint8_t> voxels = make_voxels<uint8_t>(dims);
  for (const double reduction : {1.25, kSqrt3, 2.0}) {
    PyramidSpec spec;
    spec.reduction = reduction;
    spec.levels = plc::max_levels(dims, reduction);
    spec.window_high = 200;
    spec.pad_voxels = 0;
    const Pyramid pyramid =
        must_build({VoxelType::kU8, voxels.data(), dims, spacing}, spec, kSerial);
    REQUIRE(spec.levels >= 1);
    reference::Level expected{dims, {}};
    for (const uint8_t v : voxels) expected.values.push_back(std::min(v / 200.0, 1.0));
    std::array<double, 3> extent{};
    for (size_t a = 0; a < 3; ++a) extent[a] = static_cast<double>(dims[a]) * spacing[a];
    double unit = 0.4;
    for (const PyramidLevel& level : pyramid.levels) {
      CAPTURE(reduction, level.dims[0], level.dims[1], level.dims[2]);
      REQUIRE(level.dims == expected.dims);
      const std::vector<float> values = samples::values_of(level);
      for (size_t i = 0; i < expected.values.size(); ++i) {
        REQUIRE(double{values[i]} == Approx(expected.values[i]).margin(2e-6));
      }
      expected = reference::next_level(expected, extent, reduction, unit);
      unit *= reduction;
    }
  }
}

TEST_CASE("sizes and units follow (11) and the real size stays", "[pyramid]") {
  const std::vector<uint8_t> voxels = make_voxels<uint8_t>({38, 28, 18});
  const VolumeView volume{VoxelType::kU8, voxels.data(), {38, 28, 18}, {0.5, 0.75, 2.0}};
  PyramidSpec spec;
  spec.levels = 2;
  spec.window_high = 200;
  spec.pad_voxels = 1;
  const Pyramid pyramid = must_build(volume, spec, plc::SerialExecutor(SimdTarget::kScalar));
  const Dims expected[] = {{40, 30, 20}, {23, 17, 11}, {13, 9, 6}};
  for (size_t h = 0; h < 3; ++h) {
    const PyramidLevel& level = pyramid.levels[h];
    REQUIRE(level.dims == expected[h]);
    REQUIRE(level.unit == Approx(0.5 * std::pow(kSqrt3, h)).epsilon(1e-14));
    REQUIRE(samples::values_of(level).size() ==
            static_cast<size_t>(level.dims[0] * level.dims[1] * level.dims[2]));
    const double size[3] = {20.0, 22.5, 40.0};
    for (size_t a = 0; a < 3; ++a) {
      REQUIRE(level.voxel[a] * static_cast<double>(level.dims[a]) == Approx(size[a]));
    }
  }
}

TEST_CASE("the pyramid has the same bits for every target and any number of threads", "[pyramid]") {
  const std::vector<uint16_t> voxels = make_voxels<uint16_t>({97, 61, 83});
  const VolumeView volume{VoxelType::kU16, voxels.data(), {97, 61, 83}, {0.8, 0.8, 1.3}};
  PyramidSpec spec;
  spec.window_low = 20;
  spec.window_high = 180;
  const Pyramid expected = must_build(volume, spec, plc::SerialExecutor(SimdTarget::kScalar));
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const unsigned threads : {1U, 2U, 5U}) {
      const Pyramid got = must_build(volume, spec, ThreadExecutor(threads, simd));
      for (size_t h = 0; h < got.levels.size(); ++h) {
        CAPTURE(plc::simd_target_name(simd), threads, h);
        REQUIRE(first_difference(samples::values_of(got.levels[h]),
                                 samples::values_of(expected.levels[h])) == -1);
      }
    }
  }
}

TEMPLATE_TEST_CASE("equal voxels of any type make equal pyramids", "[pyramid]", int16_t, uint16_t,
                   int32_t, float) {
  const Dims dims{17, 14, 15};
  const std::vector<uint8_t> bytes = make_voxels<uint8_t>(dims);
  const std::vector<TestType> voxels(bytes.begin(), bytes.end());
  PyramidSpec spec;
  spec.levels = 1;
  spec.window_low = 13;
  spec.window_high = 170;
  VoxelType type = VoxelType::kF32;
  if (std::is_same_v<TestType, int16_t>) type = VoxelType::kI16;
  if (std::is_same_v<TestType, uint16_t>) type = VoxelType::kU16;
  if (std::is_same_v<TestType, int32_t>) type = VoxelType::kI32;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const Pyramid expected = must_build({VoxelType::kU8, bytes.data(), dims, {1, 1, 1}}, spec,
                                        plc::SerialExecutor(simd));
    const Pyramid got =
        must_build({type, voxels.data(), dims, {1, 1, 1}}, spec, plc::SerialExecutor(simd));
    for (size_t h = 0; h < 2; ++h) {
      REQUIRE(first_difference(samples::values_of(got.levels[h]),
                               samples::values_of(expected.levels[h])) == -1);
    }
  }
}

TEST_CASE("I_0 is the caller's own volume, read where it lies", "[pyramid]") {
  const Dims dims{17, 14, 15};
  const std::vector<uint16_t> voxels = make_voxels<uint16_t>(dims);
  PyramidSpec spec;
  spec.levels = 1;
  spec.window_high = 200;
  Pyramid pyramid = must_build({VoxelType::kU16, voxels.data(), dims, {1, 1, 1}}, spec, kSerial);
  REQUIRE(pyramid.levels[0].borrowed == voxels.data());
  REQUIRE(pyramid.levels[0].values.empty());
  REQUIRE_FALSE(pyramid.levels[1].values.empty());
  REQUIRE(plc::level_image(pyramid.levels[0]).data == voxels.data());
  // One with a window that floats do not hold cannot be.
  spec.window_high = 1e35;
  const std::vector<float> floats(voxels.begin(), voxels.end());
  pyramid = must_build({VoxelType::kF32, floats.data(), dims, {1, 1, 1}}, spec, kSerial);
  REQUIRE(pyramid.levels[0].borrowed == nullptr);
}

TEST_CASE("without its values a pyramid keeps its sizes", "[pyramid]") {
  const std::vector<uint8_t> voxels = make_voxels<uint8_t>({17, 14, 15});
  PyramidSpec spec;
  spec.levels = 1;
  const Pyramid whole =
      must_build({VoxelType::kU8, voxels.data(), {17, 14, 15}, {1, 2, 1}}, spec, kSerial);
  const Pyramid bare = plc::without_values(whole);
  REQUIRE(bare.levels.size() == 2);
  for (size_t h = 0; h < 2; ++h) {
    REQUIRE(bare.levels[h].dims == whole.levels[h].dims);
    REQUIRE(bare.levels[h].voxel == whole.levels[h].voxel);
    REQUIRE(bare.levels[h].unit == whole.levels[h].unit);
    REQUIRE(bare.levels[h].values.empty());
    REQUIRE(bare.levels[h].borrowed == nullptr);
  }
}

TEST_CASE("the most levels are those whose smallest axis keeps four voxels", "[pyramid]") {
  REQUIRE(plc::max_levels({20, 20, 20}, kSqrt3) == 2);  // 11, 6, 3
  REQUIRE(plc::max_levels({400, 300, 20}, kSqrt3) == 2);
  REQUIRE(plc::max_levels({32, 32, 32}, 2.0) == 3);
  REQUIRE(plc::max_levels({31, 32, 32}, 2.0) == 2);
  REQUIRE(plc::max_levels({2, 2, 2}, 2.0) == 0);
  REQUIRE(plc::max_levels({7, 7, 7}, std::nextafter(1.0, 2.0)) == 3);  // one voxel less each time
  REQUIRE(plc::max_levels({20, 20, 20}, 1.0) == 0);
  REQUIRE(plc::max_levels({20, 20, 20}, std::nan("")) == 0);
}

TEST_CASE("what cannot be built is refused with what was found and what was expected",
          "[pyramid]") {
  const std::vector<uint8_t> voxels(8 * 8 * 8, 1);
  const VolumeView good{VoxelType::kU8, voxels.data(), {8, 8, 8}, {1, 1, 1}};
  PyramidSpec small;
  small.levels = 2;
  REQUIRE(build_status(good, small).ok());

  PyramidSpec spec = small;
  spec.levels = 9;
  require_refused(build_status(good, spec), ErrorCode::kInvalidArgument,
                  "levels 9: too deep for an image of 20 x 20 x 20 voxels at reduction 1.73; at "
                  "most 2");
  spec.levels = -1;
  require_refused(build_status(good, spec), ErrorCode::kInvalidArgument,
                  "levels -1: expected 0 or more");
  for (const double reduction : {1.0, 2.5, -1.0, std::nan("")}) {
    spec = small;
    spec.reduction = reduction;
    REQUIRE(build_status(good, spec).code() == ErrorCode::kInvalidArgument);
  }
  require_refused(build_status(good, {.reduction = 2.5}), ErrorCode::kInvalidArgument,
                  "reduction 2.5: expected more than 1 and at most 2");
  spec = small;
  spec.window_low = spec.window_high = 3;
  require_refused(build_status(good, spec), ErrorCode::kInvalidArgument,
                  "window 3 .. 3: expected finite values, the first below the second");
  for (const double high :
       {2.0, std::nan(""), std::numeric_limits<double>::infinity(), std::nextafter(0.0, 1.0)}) {
    spec.window_low = high > 1 ? 3 : 0;
    spec.window_high = high;
    REQUIRE(build_status(good, spec).code() == ErrorCode::kInvalidArgument);
  }
  spec = small;
  spec.pad_value = std::nan("");
  REQUIRE(build_status(good, spec).code() == ErrorCode::kInvalidArgument);
  spec = small;
  spec.pad_voxels = -2;
  require_refused(build_status(good, spec), ErrorCode::kInvalidArgument,
                  "padding of -2 voxels: expected 0 or more");
}

TEST_CASE("a volume that cannot be an image is refused", "[pyramid]") {
  const std::vector<uint8_t> voxels(8 * 8 * 8, 1);
  const VolumeView good{VoxelType::kU8, voxels.data(), {8, 8, 8}, {1, 1, 1}};
  const PyramidSpec spec{.levels = 0};
  VolumeView volume = good;
  volume.voxels = nullptr;
  require_refused(build_status(volume, spec), ErrorCode::kInvalidArgument,
                  "volume: voxels is null, expected the image's data");
  volume = good;
  volume.type = static_cast<VoxelType>(77);
  require_refused(build_status(volume, spec), ErrorCode::kInvalidArgument,
                  "volume: voxel type 77 is not known");
  for (const int64_t dim : {int64_t{1}, int64_t{0}, int64_t{-5}, int64_t{1} << 62}) {
    for (size_t a = 0; a < 3; ++a) {
      volume = good;
      volume.dims[a] = dim;
      REQUIRE(build_status(volume, spec).code() == ErrorCode::kInvalidData);
    }
  }
  volume.dims = {1, 8, 8};
  require_refused(build_status(volume, spec), ErrorCode::kInvalidData,
                  "image of 1 x 8 x 8 voxels: expected at least 2 on every axis, fewer than 2^31 "
                  "in a plane, fewer than 2^40 in all");
  volume.dims = {46333, 46333, 2};  // padding takes it over the limit
  require_refused(build_status(volume, spec), ErrorCode::kInvalidData,
                  "image of 46345 x 46345 x 14 voxels with its padding of 6: expected fewer than "
                  "2^31 in a plane, fewer than 2^40 in all");
  volume.dims = {2400, 2400, 2400};
  require_refused(build_status(volume, {.reduction = 1.5, .levels = 2}), ErrorCode::kInvalidData,
                  "level 1 of 1608 x 1608 x 1608 voxels: expected fewer than 2^31, as they are "
                  "floats; cut the image, or reduce more");
  volume.dims = {1279, 1279, 1300};
  // A window that floats do not hold, and voxels that they do not.
  require_refused(build_status(volume, {.levels = 0, .window_high = 1e31}), ErrorCode::kInvalidData,
                  "level 0 of 1291 x 1291 x 1312 voxels: expected fewer than 2^31, as they are "
                  "floats; cut the image, or reduce more");
  volume.type = VoxelType::kI32;
  require_refused(build_status(volume, {.levels = 0}), ErrorCode::kInvalidData,
                  "level 0 of 1291 x 1291 x 1312 voxels: expected fewer than 2^31, as they are "
                  "floats; cut the image, or reduce more");
  volume.type = good.type;
  volume.dims = {int64_t{1} << 30, int64_t{1} << 30, int64_t{1} << 30};  // 0 modulo 2^64
  REQUIRE(build_status(volume, {.levels = 0, .pad_voxels = 0}).code() == ErrorCode::kInvalidData);
  for (const double spacing : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    volume = good;
    volume.spacing[1] = spacing;
    REQUIRE(build_status(volume, spec).code() == ErrorCode::kInvalidData);
  }
  volume.spacing = {1, -1, 2.5};
  require_refused(build_status(volume, spec), ErrorCode::kInvalidData,
                  "spacing 1 x -1 x 2.5 mm: expected finite sizes greater than 0");
}

#if FIXTURES_CAN_LIMIT_MEMORY
TEST_CASE("a pyramid of bytes takes the memory of its coarse levels alone", "[pyramid]") {
  const std::vector<uint8_t> voxels(size_t{320} * 320 * 320, 7);
  PyramidSpec spec;
  spec.window_high = 10;
  const MemoryLimit limit(size_t{96} << 20);  // they take 34 MB; I_0 in floats would be 146
  const Pyramid pyramid =
      must_build({VoxelType::kU8, voxels.data(), {320, 320, 320}, {1, 1, 1}}, spec, kSerial);
  REQUIRE(pyramid.levels.size() == 4);
}

TEST_CASE("a pyramid beyond the memory is refused, not thrown", "[pyramid]") {
  const MemoryLimit limit(size_t{1} << 30);
  const uint8_t voxel = 0;  // memory runs out before any voxel is read
  const Status status =
      build_status({VoxelType::kU8, &voxel, {1200, 1200, 1200}, {1, 1, 1}}, {.levels = 1});
  require_refused(status, ErrorCode::kOutOfMemory, "pyramid of 2 levels: out of memory");
}
#endif
