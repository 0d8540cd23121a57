#include "kernels/sobel.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>

#include "kernels/scalar.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::Float4;
using plc::SimdTarget;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

// Nine rows of `width` random values, each in an allocation of its own: a sanitizer sees reads
// outside of any of them.
struct Rows {
  std::vector<std::vector<float>> values;
  std::array<const float*, 9> address{};
  Rows(size_t width, uint32_t seed) {
    for (uint32_t r = 0; r < 9; ++r) values.push_back(random_floats(width, -3, 5, seed + r));
    for (size_t r = 0; r < 9; ++r) address[r] = values[r].data();
  }
  double at(int64_t x, size_t y, size_t z) const {
    const std::vector<float>& row = values[3 * z + y];
    return double{
        row[static_cast<size_t>(std::clamp<int64_t>(x, 0, static_cast<int64_t>(row.size()) - 1))]};
  }
};

// 27 weights by definition: a difference along `axis`, means along the two others.
double expected_sobel(const Rows& rows, int64_t x, size_t axis) {
  const double difference[3] = {-0.5, 0, 0.5}, mean[3] = {0.25, 0.5, 0.25};
  double sum = 0;
  for (size_t k = 0; k < 3; ++k) {
    for (size_t j = 0; j < 3; ++j) {
      for (size_t i = 0; i < 3; ++i) {
        const size_t offset[3] = {i, j, k};
        double weight = 1;
        for (size_t a = 0; a < 3; ++a) weight *= (a == axis ? difference : mean)[offset[a]];
        sum += weight * rows.at(x + static_cast<int64_t>(i) - 1, j, k);
      }
    }
  }
  return sum;
}

struct Vectors {
  std::vector<float> axis[3];
  explicit Vectors(size_t count) {
    for (std::vector<float>& a : axis) a.assign(count, kUntouched);
  }
};

}  // namespace

TEST_CASE("the Sobel operator is a central difference, smoothed along the other axes",
          "[kernels]") {
  const std::array<float, 3> scale{1.5F, 0.7F, -0.3F};
  for (const size_t width : std::initializer_list<size_t>{1, 2, 3, 7, 8, 15, 16, 17, 33, 70}) {
    const Rows rows(width, static_cast<uint32_t>(width));
    std::vector<float> scratch(kernels::sobel_scratch(width));
    Vectors twin(width);
    scalar::sobel(rows.address.data(), width, scale, scratch.data(), twin.axis[0].data(),
                  twin.axis[1].data(), twin.axis[2].data());
    for (const SimdTarget simd : plc::available_simd_targets()) {
      CAPTURE(plc::simd_target_name(simd), width);
      Vectors got(width + 1);
      kernels::sobel(simd, rows.address.data(), width, scale, scratch.data(), got.axis[0].data(),
                     got.axis[1].data(), got.axis[2].data());
      for (size_t a = 0; a < 3; ++a) {
        REQUIRE(got.axis[a].back() == kUntouched);
        got.axis[a].pop_back();
        REQUIRE(first_difference(got.axis[a], twin.axis[a]) == -1);
        for (size_t x = 0; x < width; ++x) {
          const double expected =
              double{scale[a]} * expected_sobel(rows, static_cast<int64_t>(x), a);
          CAPTURE(a, x);
          REQUIRE(double{got.axis[a][x]} == Approx(expected).margin(3e-6));
        }
      }
    }
  }
}

TEST_CASE("the Sobel gradient of a linear ramp is its slope, half of it at a row's ends",
          "[kernels]") {
  const size_t width = 21;
  Rows rows(width, 1);
  for (size_t r = 0; r < 9; ++r) {
    const size_t y = r % 3, z = r / 3;
    for (size_t x = 0; x < width; ++x) {
      rows.values[r][x] = 2.0F * static_cast<float>(x) + 3.0F * static_cast<float>(y) -
                          0.5F * static_cast<float>(z);
    }
  }
  std::vector<float> scratch(kernels::sobel_scratch(width));
  for (const SimdTarget simd : plc::available_simd_targets()) {
    Vectors got(width);
    kernels::sobel(simd, rows.address.data(), width, {1, 1, 1}, scratch.data(), got.axis[0].data(),
                   got.axis[1].data(), got.axis[2].data());
    for (size_t x = 0; x < width; ++x) {
      REQUIRE(got.axis[0][x] == (x == 0 || x == width - 1 ? 1.0F : 2.0F));
      REQUIRE(got.axis[1][x] == 3.0F);
      REQUIRE(got.axis[2][x] == -0.5F);
    }
  }
}

TEST_CASE("vectors longer than the bound keep their direction and get length one", "[kernels]") {
  const float bound = 2.5F;
  for (const size_t count : std::initializer_list<size_t>{0, 1, 5, 16, 53}) {
    std::vector<float> g[3];
    for (uint32_t a = 0; a < 3; ++a) g[a] = random_floats(count, -3, 3, 20 + a);
    if (count > 4) {
      g[0][2] = g[1][2] = g[2][2] = 0;
      g[0][3] = 2.5F, g[1][3] = g[2][3] = 0;  // of the length of the bound itself
    }
    std::vector<Float4> twin(count);
    scalar::bound_vectors(g[0].data(), g[1].data(), g[2].data(), count, bound, twin.data());
    for (const SimdTarget simd : plc::available_simd_targets()) {
      CAPTURE(plc::simd_target_name(simd), count);
      std::vector<Float4> got(count + 1, {kUntouched, kUntouched, kUntouched, kUntouched});
      kernels::bound_vectors(simd, g[0].data(), g[1].data(), g[2].data(), count, bound, got.data());
      REQUIRE(got.back().x == kUntouched);
      got.pop_back();
      REQUIRE(first_difference(flatten(got), flatten(twin)) == -1);
      for (size_t i = 0; i < count; ++i) {
        const double length = std::hypot(double{g[0][i]}, double{g[1][i]}, double{g[2][i]});
        const double divisor = std::max(length, double{bound});
        REQUIRE(double{got[i].x} == Approx(double{g[0][i]} / divisor).margin(1e-6));
        REQUIRE(double{got[i].y} == Approx(double{g[1][i]} / divisor).margin(1e-6));
        REQUIRE(double{got[i].z} == Approx(double{g[2][i]} / divisor).margin(1e-6));
        REQUIRE(got[i].w == 0.0F);
      }
      if (count > 4) {
        REQUIRE(got[2].x == 0.0F);
        REQUIRE(got[3].x == 1.0F);
      }
    }
  }
}

TEST_CASE("norms are the lengths of the vectors times the factor", "[kernels]") {
  for (const size_t count : std::initializer_list<size_t>{0, 1, 7, 16, 37}) {
    std::vector<float> g[3];
    for (uint32_t a = 0; a < 3; ++a) g[a] = random_floats(count, -3, 3, 30 + a);
    std::vector<float> twin(count + 1, kUntouched);
    scalar::vector_norms(g[0].data(), g[1].data(), g[2].data(), count, 1.7F, twin.data());
    for (const SimdTarget simd : plc::available_simd_targets()) {
      CAPTURE(plc::simd_target_name(simd), count);
      std::vector<float> got(count + 1, kUntouched);
      kernels::vector_norms(simd, g[0].data(), g[1].data(), g[2].data(), count, 1.7F, got.data());
      REQUIRE(first_difference(got, twin) == -1);
      for (size_t i = 0; i < count; ++i) {
        REQUIRE(double{got[i]} ==
                Approx(double{1.7F} * std::hypot(double{g[0][i]}, double{g[1][i]}, double{g[2][i]}))
                    .epsilon(1e-6));
      }
    }
  }
}
