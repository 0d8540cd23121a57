#include "kernels/separable.h"

#include <array>
#include <catch2/catch.hpp>

#include "kernels/scalar.h"
#include "pyramid/buffer.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::SimdTarget;
using plc::kernels::TapsView;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

double expected_sum(const TapsView& taps, size_t output, const float* in, size_t step) {
  double sum = 0;
  for (int32_t k = 0; k < taps.taps; ++k) {
    sum += double{taps.weights[output * static_cast<size_t>(taps.taps) + static_cast<size_t>(k)]} *
           double{in[static_cast<size_t>(taps.first[output] + k) * step]};
  }
  return sum;
}

}  // namespace

TEST_CASE("a pass along X sums each row's voxels by the taps", "[kernels]") {
  for (const auto& [inputs, outputs] : std::vector<std::array<size_t, 2>>{
           {1, 1}, {2, 1}, {3, 2}, {4, 2}, {6, 3}, {37, 21}, {70, 66}}) {
    for (int32_t taps = 1; taps <= kernels::kMaxTaps && taps <= static_cast<int32_t>(inputs);
         ++taps) {
      const Taps axis(inputs, outputs, taps, 1);
      for (const size_t rows : {size_t{1}, size_t{3}, size_t{4}, size_t{8}, size_t{21}}) {
        const size_t in_stride = inputs + 2, out_stride = outputs + 3;
        // The last row ends where the allocation ends: a sanitizer sees reads past it.
        const std::vector<float> in = random_floats((rows - 1) * in_stride + inputs, 0.0F, 1.0F, 2);
        std::vector<float> twin(rows * out_stride, kUntouched);
        scalar::reduce_x(axis.view, {in.data(), inputs, in_stride}, rows,
                         {twin.data(), outputs, out_stride}, nullptr);
        for (const SimdTarget simd : plc::available_simd_targets()) {
          CAPTURE(plc::simd_target_name(simd), inputs, outputs, taps, rows);
          std::vector<float> got(rows * out_stride, kUntouched);
          plc::Buffer<float> scratch(kernels::reduce_x_scratch(inputs));
          kernels::reduce_x(simd, axis.view, {in.data(), inputs, in_stride}, rows,
                            {got.data(), outputs, out_stride}, scratch.data());
          REQUIRE(first_difference(got, twin) == -1);
          for (size_t r = 0; r < rows; ++r) {
            for (size_t i = 0; i < out_stride; ++i) {
              const double expected = i < outputs
                                          ? expected_sum(axis.view, i, in.data() + r * in_stride, 1)
                                          : double{kUntouched};
              REQUIRE(double{got[r * out_stride + i]} == Approx(expected).margin(1e-6));
            }
          }
        }
      }
    }
  }
}

TEST_CASE("a pass along Y sums rows by the taps of any part of the outputs", "[kernels]") {
  const size_t inputs = 23, outputs = 13;
  for (int32_t taps = 1; taps <= kernels::kMaxTaps; ++taps) {
    const Taps axis(inputs, outputs, taps, 3);
    for (const size_t width : {size_t{1}, size_t{5}, size_t{16}, size_t{35}}) {
      const size_t stride = width + 1;
      const std::vector<float> in = random_floats(inputs * stride, 0.0F, 1.0F, 4);
      for (const auto& [begin, end] :
           std::vector<std::array<size_t, 2>>{{0, 13}, {5, 9}, {12, 13}, {4, 4}}) {
        const float* from = in.data() + static_cast<size_t>(axis.first[begin]) * stride;
        std::vector<float> twin(outputs * stride, kUntouched);
        scalar::reduce_y(axis.view, begin, end, {from, width, stride},
                         {twin.data(), width, stride});
        for (const SimdTarget simd : plc::available_simd_targets()) {
          CAPTURE(plc::simd_target_name(simd), taps, width, begin, end);
          std::vector<float> got(outputs * stride, kUntouched);
          kernels::reduce_y(simd, axis.view, begin, end, {from, width, stride},
                            {got.data(), width, stride});
          REQUIRE(first_difference(got, twin) == -1);
          for (size_t j = 0; j < outputs; ++j) {
            for (size_t i = 0; i < stride; ++i) {
              const double expected =
                  i < width && j < end - begin
                      ? expected_sum(axis.view, begin + j, in.data() + i, stride)
                      : double{kUntouched};
              REQUIRE(double{got[j * stride + i]} == Approx(expected).margin(1e-6));
            }
          }
        }
      }
    }
  }
}

TEST_CASE("the pass along Z limits its values to one", "[kernels]") {
  for (int32_t taps = 1; taps <= kernels::kMaxTaps; ++taps) {
    for (const size_t count : {size_t{0}, size_t{1}, size_t{15}, size_t{16}, size_t{53}}) {
      std::vector<std::vector<float>> planes;
      std::vector<const float*> addresses;
      for (int32_t k = 0; k < taps; ++k) {
        planes.push_back(random_floats(count, 0.0F, 1.0F, 5 + static_cast<uint32_t>(k)));
      }
      for (const std::vector<float>& plane : planes) addresses.push_back(plane.data());
      const std::vector<float> weights =
          random_floats(static_cast<size_t>(taps), 0.0F, 3.0F / static_cast<float>(taps), 6);
      std::vector<float> twin(count + 1, kUntouched);
      scalar::reduce_z(weights.data(), taps, addresses.data(), count, twin.data());
      for (const SimdTarget simd : plc::available_simd_targets()) {
        CAPTURE(plc::simd_target_name(simd), taps, count);
        std::vector<float> got(count + 1, kUntouched);
        kernels::reduce_z(simd, weights.data(), taps, addresses.data(), count, got.data());
        REQUIRE(first_difference(got, twin) == -1);
        REQUIRE(got[count] == kUntouched);
        for (size_t i = 0; i < count; ++i) {
          double sum = 0;
          for (size_t k = 0; k < planes.size(); ++k) {
            sum += double{weights[k]} * double{planes[k][i]};
          }
          REQUIRE(double{got[i]} == Approx(std::min(sum, 1.0)).margin(1e-6));
        }
      }
    }
  }
}
