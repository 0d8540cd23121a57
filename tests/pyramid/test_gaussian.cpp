#include "pyramid/gaussian.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::SimdTarget;
using Dims = std::array<int64_t, 3>;
using Vector = std::array<double, 3>;

const plc::SerialExecutor kSerial;

std::vector<float> convolved(std::vector<float> image, const Dims& dims, const Vector& sigma,
                             const plc::Executor& executor) {
  std::vector<float> blurred(image.size(), kUntouched);
  REQUIRE(plc::convolve_gaussian(image.data(), dims, sigma, executor, blurred.data()));
  return blurred;
}

// Weight `i` voxels away, not normalised.
double gaussian(double i, double sigma) {
  return i == 0 ? 1.0 : std::exp(-0.5 * (i / sigma) * (i / sigma));
}

// The whole 3D convolution at a voxel by definition, not separated.
double expected_value(const std::vector<float>& image, const Dims& dims, const Vector& sigma,
                      const Dims& at) {
  int64_t radius[3];
  for (size_t a = 0; a < 3; ++a) radius[a] = static_cast<int64_t>(std::ceil(3 * sigma[a]));
  double sum = 0, weights = 0;
  for (int64_t k = -radius[2]; k <= radius[2]; ++k) {
    for (int64_t j = -radius[1]; j <= radius[1]; ++j) {
      for (int64_t i = -radius[0]; i <= radius[0]; ++i) {
        const int64_t x = std::clamp<int64_t>(at[0] + i, 0, dims[0] - 1);
        const int64_t y = std::clamp<int64_t>(at[1] + j, 0, dims[1] - 1);
        const int64_t z = std::clamp<int64_t>(at[2] + k, 0, dims[2] - 1);
        const double weight = gaussian(static_cast<double>(i), sigma[0]) *
                              gaussian(static_cast<double>(j), sigma[1]) *
                              gaussian(static_cast<double>(k), sigma[2]);
        weights += weight;
        sum += weight * double{image[static_cast<size_t>(x + dims[0] * (y + dims[1] * z))]};
      }
    }
  }
  return sum / weights;
}

}  // namespace

TEST_CASE("a Gaussian is sampled to three deviations and sums to one", "[pyramid]") {
  for (const double sigma : {0.0, 1e-300, 0.1, 0.5, 1.0, 1.0001, 2.7}) {
    CAPTURE(sigma);
    const std::vector<float> weights = plc::gaussian_weights(sigma);
    const int64_t radius = plc::gaussian_radius(sigma);
    REQUIRE(radius == static_cast<int64_t>(std::ceil(3 * sigma)));
    REQUIRE(weights.size() == static_cast<size_t>(2 * radius + 1));
    double sum = 0;
    for (size_t k = 0; k < weights.size(); ++k) {
      REQUIRE(weights[k] == weights[weights.size() - 1 - k]);
      REQUIRE(double{weights[k]} ==
              Approx(double{weights[static_cast<size_t>(radius)]} *
                     gaussian(static_cast<double>(k) - static_cast<double>(radius), sigma))
                  .margin(1e-7));
      sum += double{weights[k]};
    }
    REQUIRE(sum == Approx(1.0).margin(3e-7));
  }
  REQUIRE(plc::gaussian_weights(0.0) == std::vector<float>{1.0F});
}

TEST_CASE("separate axes make the whole 3D Gaussian, borders replicated", "[pyramid]") {
  const Dims dims{11, 7, 9};
  const std::vector<float> image = random_floats(11 * 7 * 9, 0, 1, 1);
  for (const Vector& sigma :
       {Vector{0.8, 0.8, 0.8}, Vector{1.9, 0.6, 0.3}, Vector{0.2, 2.3, 0}, Vector{0, 0, 3.0}}) {
    for (const SimdTarget simd : plc::available_simd_targets()) {
      const std::vector<float> got = convolved(image, dims, sigma, plc::SerialExecutor(simd));
      size_t i = 0;
      for (int64_t z = 0; z < dims[2]; ++z) {
        for (int64_t y = 0; y < dims[1]; ++y) {
          for (int64_t x = 0; x < dims[0]; ++x, ++i) {
            CAPTURE(plc::simd_target_name(simd), sigma[0], x, y, z);
            REQUIRE(double{got[i]} ==
                    Approx(expected_value(image, dims, sigma, {x, y, z})).margin(1e-6));
          }
        }
      }
    }
  }
}

TEST_CASE("the Gaussian of a step is the error function", "[pyramid]") {
  const Dims dims{64, 3, 2};
  std::vector<float> image;
  for (size_t i = 0; i < 64 * 6; ++i) image.push_back(i % 64 < 32 ? 0.0F : 1.0F);
  const double sigma = 4;
  const std::vector<float> got = convolved(image, dims, {sigma, sigma / 9, 0}, kSerial);
  for (size_t i = 0; i < got.size(); ++i) {
    const double from_step = static_cast<double>(i % 64) - 31.5;
    // Cut at three deviations, sampled: a third of a percent.
    REQUIRE(double{got[i]} ==
            Approx(0.5 * std::erfc(-from_step / (sigma * std::sqrt(2.0)))).margin(0.003));
  }
}

TEST_CASE("a Gaussian image has the same bits for every target and any number of threads",
          "[pyramid]") {
  const Dims dims{131, 67, 21};  // more than one column of values
  const std::vector<float> image = random_floats(131 * 67 * 21, 0, 1, 2);
  const Vector sigma{1.5, 1.2, 0.7};
  const std::vector<float> expected =
      convolved(image, dims, sigma, plc::SerialExecutor(SimdTarget::kScalar));
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const unsigned threads : {1U, 2U, 3U}) {
      CAPTURE(plc::simd_target_name(simd), threads);
      const std::vector<float> got = convolved(image, dims, sigma, ThreadExecutor(threads, simd));
      REQUIRE(first_difference(got, expected) == -1);
    }
  }
}
