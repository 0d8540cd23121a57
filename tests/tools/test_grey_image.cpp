#include "tools/view/grey_image.h"

#include <catch2/catch.hpp>
#include <limits>

namespace {

using plc::tools::grey_image;
using plc::tools::GreyImage;
using plc::tools::GreyWindow;

constexpr int64_t kMany = 1 << 24;

template <typename T>
plc_image image_of(const std::vector<T>& voxels, plc_voxel_type type, int64_t nx, int64_t ny,
                   int64_t nz) {
  REQUIRE(voxels.size() == static_cast<size_t>(nx * ny * nz));
  plc_image image;
  plc_image_defaults(&image);
  image.type = type;
  image.voxels = voxels.data();
  image.dims[0] = nx;
  image.dims[1] = ny;
  image.dims[2] = nz;
  return image;
}

}  // namespace

TEST_CASE("integers over at most 256 values are kept as they are", "[view]") {
  const std::vector<int16_t> voxels = {-3, 0, 7, 200, 252, 251, 1, -3};
  const GreyImage grey = grey_image(image_of(voxels, PLC_I16, 2, 2, 2), {}, kMany);
  CHECK(grey.window.step() == 1);
  for (size_t i = 0; i < voxels.size(); ++i) CHECK(grey.voxels[i] + grey.window.low == voxels[i]);
  CHECK_FALSE(grey.reduced());
  CHECK(grey.exact);
}

TEST_CASE("a few extreme voxels do not widen the window", "[view]") {
  std::vector<float> voxels(64 * 64 * 64);
  for (size_t i = 0; i < voxels.size(); ++i) voxels[i] = static_cast<float>(i % 1000);
  voxels[5] = 1e9F;
  voxels[6] = std::numeric_limits<float>::quiet_NaN();
  voxels[7] = -std::numeric_limits<float>::infinity();
  const GreyImage grey = grey_image(image_of(voxels, PLC_F32, 64, 64, 64), {}, kMany);
  CHECK(grey.high == 1e9);
  CHECK(grey.low == 0);
  CHECK(grey.window.high < 1e6);
  CHECK(grey.voxels[5] == 255);
  CHECK(grey.voxels[6] == 0);
  CHECK(grey.voxels[7] == 0);
}

TEST_CASE("a window that is asked for is the one there is", "[view]") {
  const std::vector<uint16_t> voxels = {0, 100, 150, 200, 60000, 120, 100, 200};
  const GreyImage grey =
      grey_image(image_of(voxels, PLC_U16, 2, 2, 2), GreyWindow{100, 200}, kMany);
  CHECK(grey.voxels == std::vector<uint8_t>{0, 0, 128, 255, 255, 51, 0, 255});
  CHECK(grey.low == 0);
  CHECK(grey.high == 60000);
  CHECK_FALSE(grey.exact);
}

TEST_CASE("a large image is reduced along its short voxels, each the mean of those it stands for",
          "[view]") {
  std::vector<uint8_t> voxels;
  for (uint8_t z = 0; z < 4; ++z) {
    for (uint8_t y = 0; y < 6; ++y) {
      for (uint8_t x = 0; x < 5; ++x) voxels.push_back(static_cast<uint8_t>(10 * x + y + 60 * z));
    }
  }
  plc_image image = image_of(voxels, PLC_U8, 5, 6, 4);
  image.spacing[2] = 9;
  const GreyImage grey = grey_image(image, GreyWindow{0, 255}, 40);
  REQUIRE(grey.reduction == std::array<int64_t, 3>{2, 2, 1});
  REQUIRE(grey.dims == std::array<int64_t, 3>{3, 3, 4});
  CHECK(grey.voxels[0] == 6);       // (0 + 10 + 1 + 11) / 4, rounded
  CHECK(grey.voxels[1] == 26);      // 20 more
  CHECK(grey.voxels[2] == 41);      // at the border two voxels, 40 and 41: 40.5
  CHECK(grey.voxels[9 + 0] == 66);  // the next slice
}

TEST_CASE("images of one value, and of none that is finite, have a window", "[view]") {
  const std::vector<float> same(8, 3.5F);
  CHECK(grey_image(image_of(same, PLC_F32, 2, 2, 2), {}, kMany).window.low == 3.5);
  const std::vector<float> none(8, std::numeric_limits<float>::quiet_NaN());
  const GreyImage grey = grey_image(image_of(none, PLC_F32, 2, 2, 2), {}, kMany);
  CHECK(grey.voxels == std::vector<uint8_t>(8, 0));
  CHECK(grey.window.high > grey.window.low);
}
