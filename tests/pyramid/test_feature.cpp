#include "pyramid/feature.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/limited_memory.h"

namespace {

using namespace fixtures;
using plc::Buffer;
using plc::ErrorCode;
using plc::SimdTarget;
using plc::Status;
using plc::VolumeView;
using plc::VoxelType;
using Dims = std::array<int64_t, 3>;
using Vector = std::array<double, 3>;

const plc::SerialExecutor kSerial;

std::vector<float> must_build(const VolumeView& volume, double sigma,
                              const plc::Executor& executor) {
  Buffer<float> norm;
  const Status status = plc::gradient_norm(volume, sigma, executor, norm);
  CAPTURE(status.message());
  REQUIRE(status.ok());
  REQUIRE(norm.size() == static_cast<size_t>(volume.dims[0] * volume.dims[1] * volume.dims[2]));
  return {norm.begin(), norm.end()};
}

// A volume in doubles with replicated borders.
struct Reference {
  Dims dims;
  std::vector<double> values;
  double at(int64_t x, int64_t y, int64_t z) const {
    x = std::clamp<int64_t>(x, 0, dims[0] - 1);
    y = std::clamp<int64_t>(y, 0, dims[1] - 1);
    z = std::clamp<int64_t>(z, 0, dims[2] - 1);
    return values[static_cast<size_t>(x + dims[0] * (y + dims[1] * z))];
  }
};

// value(x, y, z) at every voxel.
template <typename Value>
Reference map_voxels(const Dims& dims, const Value& value) {
  Reference result{dims, {}};
  for (int64_t z = 0; z < dims[2]; ++z) {
    for (int64_t y = 0; y < dims[1]; ++y) {
      for (int64_t x = 0; x < dims[0]; ++x) result.values.push_back(value(x, y, z));
    }
  }
  return result;
}

// The convolution with a 3D Gaussian of `sigma` mm by definition.
Reference blurred(const Reference& image, const Vector& spacing, double sigma) {
  if (sigma == 0) return image;
  int64_t radius[3];
  for (size_t a = 0; a < 3; ++a)
    radius[a] = static_cast<int64_t>(std::ceil(3 * sigma / spacing[a]));
  return map_voxels(image.dims, [&](int64_t x, int64_t y, int64_t z) {
    double sum = 0, weights = 0;
    for (int64_t k = -radius[2]; k <= radius[2]; ++k) {
      for (int64_t j = -radius[1]; j <= radius[1]; ++j) {
        for (int64_t i = -radius[0]; i <= radius[0]; ++i) {
          const double dx = static_cast<double>(i) * spacing[0];
          const double dy = static_cast<double>(j) * spacing[1];
          const double dz = static_cast<double>(k) * spacing[2];
          const double weight = std::exp(-(dx * dx + dy * dy + dz * dz) / (2 * sigma * sigma));
          weights += weight;
          sum += weight * image.at(x + i, y + j, z + k);
        }
      }
    }
    return sum / weights;
  });
}

Reference sobel_norm(const Reference& image, const Vector& spacing) {
  const double difference[3] = {-0.5, 0, 0.5}, mean[3] = {0.25, 0.5, 0.25};
  return map_voxels(image.dims, [&](int64_t x, int64_t y, int64_t z) {
    double squared = 0;
    for (int axis = 0; axis < 3; ++axis) {
      double sum = 0;
      for (int corner = 0; corner < 27; ++corner) {
        const int offset[3] = {corner % 3, corner / 3 % 3, corner / 9};
        double weight = 1;
        for (int a = 0; a < 3; ++a) weight *= (a == axis ? difference : mean)[offset[a]];
        sum += weight * image.at(x + offset[0] - 1, y + offset[1] - 1, z + offset[2] - 1);
      }
      squared +=
          sum * sum / (spacing[static_cast<size_t>(axis)] * spacing[static_cast<size_t>(axis)]);
    }
    return std::sqrt(squared);
  });
}

template <typename T>
void require_definition(VoxelType type, const Dims& dims, double low, double high) {
  const Vector spacing{0.7, 1.1, 2.3};
  std::vector<T> voxels;
  for (const float v : random_floats(static_cast<size_t>(dims[0] * dims[1] * dims[2]), 0, 1, 5)) {
    voxels.push_back(static_cast<T>(low + double{v} * (high - low)));
  }
  const Reference image{dims, {voxels.begin(), voxels.end()}};
  for (const double sigma : {0.0, 0.05, 0.9, 2.0}) {
    const Reference expected = sobel_norm(blurred(image, spacing, sigma), spacing);
    for (const SimdTarget simd : plc::available_simd_targets()) {
      const std::vector<float> got =
          must_build({type, voxels.data(), dims, spacing}, sigma, plc::SerialExecutor(simd));
      for (size_t i = 0; i < got.size(); ++i) {
        CAPTURE(plc::simd_target_name(simd), sigma, i, static_cast<int>(type));
        REQUIRE(double{got[i]} == Approx(expected.values[i]).margin(1e-6 * (high - low)));
      }
    }
  }
}

Status norm_status(const VolumeView& volume, double sigma) {
  Buffer<float> norm(7);  // of an earlier use
  Status status = plc::gradient_norm(volume, sigma, plc::SerialExecutor(SimdTarget::kScalar), norm);
  if (!status.ok()) REQUIRE(norm.empty());
  return status;
}

}  // namespace

TEST_CASE("a feature image takes two float images, not three", "[pyramid]") {
  const Dims dims{64, 64, 32};
  const plc::Vector<uint8_t> voxels(size_t{64} * 64 * 32, 1);
  const VolumeView volume{VoxelType::kU8, voxels.data(), dims, {1, 1, 1}};
  const auto image = static_cast<int64_t>(voxels.size() * sizeof(float));
  for (const double sigma : {0.0, 0.3}) {
    plc::Memory memory;
    const plc::MemoryScope scope(memory);
    REQUIRE(norm_status(volume, sigma).ok());
    CHECK(memory.peak() > image);
    CHECK(memory.peak() < 2 * image + image / 4);
  }
}

TEST_CASE("the feature image is the norm of the Sobel gradient of the Gaussian image in mm",
          "[pyramid]") {
  require_definition<uint8_t>(VoxelType::kU8, {9, 7, 5}, 0, 255);
  require_definition<int16_t>(VoxelType::kI16, {9, 7, 5}, -1000, 3000);
  require_definition<uint16_t>(VoxelType::kU16, {9, 7, 5}, 0, 65535);
  require_definition<int32_t>(VoxelType::kI32, {9, 7, 5}, -2e9, 2e9);
  require_definition<float>(VoxelType::kF32, {17, 9, 3}, -3, 5);
}

TEST_CASE("contrast survives a value that is large against it", "[pyramid]") {
  // Steps of 1 on a billion, which a float does not hold.
  const Dims dims{8, 4, 4};
  std::vector<int32_t> voxels(8 * 16);
  for (size_t i = 0; i < voxels.size(); ++i) voxels[i] = 1000000000 + static_cast<int32_t>(i % 8);
  const std::vector<float> got =
      must_build({VoxelType::kI32, voxels.data(), dims, {0.5, 1, 1}}, 0, kSerial);
  for (size_t i = 0; i < got.size(); ++i) {
    REQUIRE(got[i] == Approx(i % 8 == 0 || i % 8 == 7 ? 1.0 : 2.0).epsilon(1e-6));
  }
}

TEST_CASE("the norm at a smoothed step is the Gaussian's peak, whatever the voxels", "[pyramid]") {
  // A step of 100 across z, whose voxels are 0.5 mm; sigma 2 mm: 100 / (2 sqrt(2 pi)) per mm.
  const Dims dims{5, 4, 48};
  std::vector<int16_t> voxels(5 * 4 * 48, 50);
  std::fill_n(voxels.begin(), 5 * 4 * 24, int16_t{-50});
  const std::vector<float> got =
      must_build({VoxelType::kI16, voxels.data(), dims, {2, 3, 0.5}}, 2.0, kSerial);
  const double peak = 100 / (2.0 * std::sqrt(2 * 3.141592653589793));
  for (size_t i = 0; i < got.size(); ++i) {
    const size_t plane = i / 20;
    const double from_step = (static_cast<double>(plane) - 23.5) * 0.5;
    const double expected = peak * std::exp(-from_step * from_step / 8);
    CAPTURE(i);
    REQUIRE(double{got[i]} == Approx(expected).margin(0.02 * peak));
  }
}

TEST_CASE("the feature image has the same bits for every target and any number of threads",
          "[pyramid]") {
  const Dims dims{77, 61, 23};
  std::vector<float> voxels = random_floats(77 * 61 * 23, -100, 900, 6);
  voxels[500] = std::numeric_limits<float>::quiet_NaN();
  voxels[501] = std::numeric_limits<float>::infinity();
  const VolumeView volume{VoxelType::kF32, voxels.data(), dims, {0.8, 1, 1.5}};
  for (const double sigma : {0.0, 1.3}) {
    const std::vector<float> expected =
        must_build(volume, sigma, plc::SerialExecutor(SimdTarget::kScalar));
    for (const SimdTarget simd : plc::available_simd_targets()) {
      for (const unsigned threads : {1U, 2U, 3U}) {
        CAPTURE(plc::simd_target_name(simd), threads, sigma);
        const std::vector<float> got = must_build(volume, sigma, ThreadExecutor(threads, simd));
        REQUIRE(first_difference(got, expected) == -1);
      }
    }
  }
}

TEST_CASE("voxels that are not finite count as the nearest that is", "[pyramid]") {
  const Dims dims{6, 5, 4};
  std::vector<float> voxels = random_floats(6 * 5 * 4, 2, 3, 7);
  voxels[3] = 1.0F, voxels[9] = 4.0F;
  std::vector<float> wild = voxels;
  voxels[30] = 1.0F, wild[30] = std::numeric_limits<float>::quiet_NaN();
  voxels[50] = 1.0F, wild[50] = -std::numeric_limits<float>::infinity();
  voxels[70] = 4.0F, wild[70] = std::numeric_limits<float>::infinity();
  const auto norm = [&](const std::vector<float>& of) {
    return must_build({VoxelType::kF32, of.data(), dims, {1, 1, 1}}, 0.6, kSerial);
  };
  REQUIRE(first_difference(norm(wild), norm(voxels)) == -1);
}

TEST_CASE("an image of one value has no contours", "[pyramid]") {
  std::vector<float> voxels(27, -7.25F);
  for (const bool infinite : {false, true}) {
    if (infinite) voxels.assign(27, std::numeric_limits<float>::infinity());
    for (const float v :
         must_build({VoxelType::kF32, voxels.data(), {3, 3, 3}, {1, 1, 1}}, 0.5, kSerial)) {
      REQUIRE(v == 0.0F);
    }
  }
}

TEST_CASE("a deviation that no image can be convolved with is refused", "[pyramid]") {
  const plc::Vector<uint8_t> voxels(8 * 6 * 4, 1);
  const VolumeView volume{VoxelType::kU8, voxels.data(), {8, 6, 4}, {1, 1, 2}};
  REQUIRE(norm_status(volume, 2.0).ok());  // 6 of 8, 6 of 6 and 3 of 4 voxels
  REQUIRE(norm_status(volume, 2.01).message() ==
          "sigma 2.01 mm: 3 sigma reach beyond the image of 8 x 6 x 4 voxels");
  REQUIRE(norm_status(volume, -0.5).message() ==
          "sigma -0.5 mm: expected a finite value of 0 or more");
  for (const double sigma :
       {-1e-300, 1e300, std::nan(""), std::numeric_limits<double>::infinity()}) {
    REQUIRE(norm_status(volume, sigma).code() == ErrorCode::kInvalidArgument);
  }
}

TEST_CASE("the feature of a volume that cannot be an image is refused", "[pyramid]") {
  const plc::Vector<uint8_t> voxels(8, 1);
  VolumeView volume{VoxelType::kU8, nullptr, {2, 2, 2}, {1, 1, 1}};
  REQUIRE(norm_status(volume, 0).code() == ErrorCode::kInvalidArgument);
  volume.voxels = voxels.data();
  REQUIRE(norm_status(volume, 0).ok());
  volume.dims = {1 << 20, 1 << 20, 1 << 24};  // 0 modulo 2^64
  REQUIRE(norm_status(volume, 0).code() == ErrorCode::kInvalidData);
  volume.dims = {1 << 11, 1 << 10, 1 << 10};
  REQUIRE(norm_status(volume, 0).message() ==
          "gradient norm of 2048 x 1024 x 1024 voxels: expected fewer than 2^31");
  volume.dims = {2, 2, 2};
  volume.spacing[1] = 0;
  REQUIRE(norm_status(volume, 0).code() == ErrorCode::kInvalidData);
}

#if FIXTURES_CAN_LIMIT_MEMORY
TEST_CASE("a feature image beyond the memory is refused, not thrown", "[pyramid]") {
  const MemoryLimit limit(size_t{1} << 30);
  const uint8_t voxel = 0;  // memory runs out before any voxel is read
  const Status status = norm_status({VoxelType::kU8, &voxel, {1200, 1200, 1200}, {1, 1, 1}}, 1);
  REQUIRE(status.code() == ErrorCode::kOutOfMemory);
  REQUIRE(status.message() == "gradient norm of 1200 x 1200 x 1200 voxels: out of memory");
}
#endif
