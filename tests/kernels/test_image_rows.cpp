#include "kernels/image_rows.h"

#include <catch2/catch.hpp>
#include <limits>

#include "kernels/scalar.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/typed_images.h"

namespace {

using namespace fixtures;
using plc::ImageView;
using plc::SimdTarget;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

}  // namespace

TEMPLATE_TEST_CASE("rows of typed images have the bits of their single values on every target",
                   "[kernels]", uint8_t, int16_t, uint16_t, float) {
  for (const int32_t pad : {0, 1, 6}) {
    for (const int32_t width : {2, 3, 16, 37}) {
      const TypedImage<TestType> image(width, 5, 4, pad, 7, 0.2F);
      const auto columns = static_cast<size_t>(image.view.dims[0]);
      for (const SimdTarget simd : plc::available_simd_targets()) {
        for (int64_t z = 0; z < image.view.dims[2]; ++z) {
          const int64_t first = z % 2, end = image.view.dims[1];
          const size_t count = static_cast<size_t>(end - first) * columns;
          std::vector<float> got(count + 1, kUntouched), twin = got;
          kernels::image_rows(simd, image.view, z, first, end, got.data());
          scalar::image_rows(image.view, z, first, end, twin.data());
          CAPTURE(plc::simd_target_name(simd), pad, width, z);
          REQUIRE(first_difference(got, twin) == -1);
          REQUIRE(got[count] == kUntouched);
          for (size_t i = 0; i < count; ++i) {
            const auto x = static_cast<int64_t>(i % columns);
            const auto y = first + static_cast<int64_t>(i / columns);
            REQUIRE(got[i] == plc::image_value(image.view, x, y, z));
          }
        }
      }
    }
  }
}

TEST_CASE("values are the window's part of the voxel, clipped, and the padding's value outside",
          "[kernels]") {
  const std::vector<int16_t> voxels = {-200, 100, 300, 500, 501, 32767, -32768, 200};
  ImageView image;
  image.data = voxels.data();
  for (int32_t& dim : image.dims) dim = 4;
  image.form = {plc::ImageType::kI16, 1, 0.25F, 100, 1 / 400.0F};
  const std::vector<float> expected = {0, 0, 0.5F, 1, 1, 1, 0, 0.25F};
  size_t i = 0;
  for (int64_t z = 0; z < 4; ++z) {
    for (int64_t y = 0; y < 4; ++y) {
      for (int64_t x = 0; x < 4; ++x) {
        const bool inside = std::min({x, y, z}) >= 1 && std::max({x, y, z}) <= 2;
        CAPTURE(x, y, z);
        REQUIRE(plc::image_value(image, x, y, z) == (inside ? expected[i] : 0.25F));
        i += inside ? 1 : 0;
      }
    }
  }
}

TEST_CASE("floats that are no numbers are dark or clipped on every target", "[kernels]") {
  const float inf = std::numeric_limits<float>::infinity();
  std::vector<float> voxels(24, std::nanf(""));
  for (size_t i = 1; i < voxels.size(); i += 3) voxels[i] = inf;
  for (size_t i = 2; i < voxels.size(); i += 3) voxels[i] = -inf;
  ImageView image;
  image.data = voxels.data();
  image.dims[0] = 24;
  image.dims[1] = image.dims[2] = 1;
  image.form = {plc::ImageType::kF32, 0, 0, -1, 0.5F};
  for (const SimdTarget simd : plc::available_simd_targets()) {
    std::vector<float> got(24);
    kernels::image_rows(simd, image, 0, 0, 1, got.data());
    for (size_t i = 0; i < got.size(); ++i) REQUIRE(got[i] == (i % 3 == 1 ? 1.0F : 0.0F));
  }
}
