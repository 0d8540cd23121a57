#include "kernels/weighted_rows.h"

#include <catch2/catch.hpp>

#include "kernels/scalar.h"
#include "tests/samples/kernel_fixtures.h"

using namespace fixtures;
using plc::SimdTarget;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

TEST_CASE("weighted rows are summed in order on any part of them", "[kernels]") {
  const size_t width = 53;
  for (const size_t taps : std::initializer_list<size_t>{1, 2, 7, 25}) {
    std::vector<std::vector<float>> values;
    std::vector<const float*> rows;
    rows.reserve(taps);
    for (uint32_t k = 0; k < taps; ++k) values.push_back(random_floats(width, -2, 2, 10 + k));
    for (const std::vector<float>& row : values) rows.push_back(row.data());
    const std::vector<float> weights = random_floats(taps, -1, 1, 3);
    for (const auto& [begin, end] :
         std::vector<std::array<size_t, 2>>{{0, 53}, {1, 52}, {16, 32}, {50, 53}, {9, 9}}) {
      std::vector<float> twin(width, kUntouched);
      scalar::weighted_rows(weights.data(), taps, rows.data(), begin, end, twin.data());
      for (const SimdTarget simd : plc::available_simd_targets()) {
        CAPTURE(plc::simd_target_name(simd), taps, begin, end);
        std::vector<float> got(width, kUntouched);
        kernels::weighted_rows(simd, weights.data(), taps, rows.data(), begin, end, got.data());
        REQUIRE(first_difference(got, twin) == -1);
        for (size_t i = 0; i < width; ++i) {
          double sum = 0;
          for (size_t k = 0; k < taps; ++k) sum += double{weights[k]} * double{values[k][i]};
          const double expected = i >= begin && i < end ? sum : double{kUntouched};
          REQUIRE(double{got[i]} == Approx(expected).margin(1e-5));
        }
      }
    }
  }
}
