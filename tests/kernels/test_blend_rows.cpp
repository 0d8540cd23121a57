#include "kernels/blend_rows.h"

#include <catch2/catch.hpp>

#include "kernels/image_force.h"
#include "kernels/image_value.h"
#include "kernels/scalar.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::SimdTarget;
namespace kernels = plc::kernels;

}  // namespace

TEST_CASE("rows blended along y and z finish trilinear sampling, bit for bit", "[kernels]") {
  const int32_t width = 37;
  const std::vector<float> voxels = random_floats(width * 2 * 2, 0, 1, 3);
  plc::ImageView image;
  image.data = voxels.data();
  image.dims[0] = width;
  image.dims[1] = image.dims[2] = 2;
  const float y = 0.3F, z = 0.81F;
  // Along x first: at places between the voxels.
  std::vector<float> rows[4], expected;
  std::vector<plc::Float4> place;
  for (size_t i = 0; i < 90; ++i) {
    const float x = 0.41F * static_cast<float>(i);
    place.push_back({x, y, z, 0});
    const plc::AxisCell cell = plc::axis_cell(x, 1, 0, width);
    for (size_t r = 0; r < 4; ++r) {
      const float* at = voxels.data() + r * width + cell.index;
      rows[r].push_back(at[0] + (at[1] - at[0]) * cell.fraction);
    }
  }
  for (const SimdTarget simd : plc::available_simd_targets()) {
    expected.assign(90, 0);
    kernels::sample_trilinear(simd, image, place.data(), 0, 90, expected.data());
    for (const size_t begin : {0U, 1U, 17U}) {
      for (const size_t end : {90U, 71U, 18U}) {
        std::vector<float> got(90, kUntouched);
        kernels::blend_rows(simd, {rows[0].data(), rows[1].data(), rows[2].data(), rows[3].data()},
                            y, z, begin, end, got.data());
        CAPTURE(plc::simd_target_name(simd), begin, end);
        for (size_t i = 0; i < 90; ++i) {
          REQUIRE(got[i] == (i >= begin && i < end ? expected[i] : kUntouched));
        }
      }
    }
  }
}
