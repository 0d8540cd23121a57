#include "tools/volume/labels.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tools/tool_fixtures.h"

namespace {

using fixtures::failure_of;
using plc::tools::crop_label;
using plc::tools::find_labels;
using plc::tools::Label;
using plc::tools::LabelCrop;

using Indices = std::array<int64_t, 3>;

template <typename T>
plc_image image_of(plc_voxel_type type, const std::vector<T>& voxels, const Indices& dims) {
  plc_image image;
  plc_image_defaults(&image);
  image.type = type;
  image.voxels = voxels.data();
  std::copy(dims.begin(), dims.end(), image.dims);
  return image;
}

template <typename T>
void check_table(plc_voxel_type type) {
  CAPTURE(type);
  // Two rows of four in each of two slices.
  const std::vector<T> voxels = {7, 7, 0, 3, 0, 7, 0, 0, 0, 0, 3, 3, 3, 0, 0, 7};
  const auto labels = find_labels("image", image_of(type, voxels, {4, 2, 2}));
  REQUIRE(labels.size() == 2);
  CHECK(labels[0].value == 3);
  CHECK(labels[0].voxels == 4);
  CHECK(labels[0].low == Indices{0, 0, 0});
  CHECK(labels[0].high == Indices{3, 1, 1});
  CHECK(labels[1].value == 7);
  CHECK(labels[1].voxels == 4);
  CHECK(labels[1].low == Indices{0, 0, 0});
  CHECK(labels[1].high == Indices{3, 1, 1});
}

}  // namespace

TEST_CASE("Labels of every voxel type are counted and boxed", "[labels]") {
  check_table<uint8_t>(PLC_U8);
  check_table<int16_t>(PLC_I16);
  check_table<uint16_t>(PLC_U16);
  check_table<int32_t>(PLC_I32);
  check_table<float>(PLC_F32);
}

TEST_CASE("A label's box is as narrow as the label", "[labels]") {
  std::vector<uint8_t> voxels(size_t{5} * 6 * 7, 0);
  for (const size_t z : {2U, 3U}) voxels[1 + 5 * (4 + 6 * z)] = 9;
  const auto labels = find_labels("image", image_of(PLC_U8, voxels, {5, 6, 7}));
  REQUIRE(labels.size() == 1);
  CHECK(labels[0].low == Indices{1, 4, 2});
  CHECK(labels[0].high == Indices{1, 4, 3});
}

TEST_CASE("Labels may be negative and are in ascending order", "[labels]") {
  const std::vector<int32_t> voxels = {2147483647, -5, 0, -2147483647 - 1, 4, 4, 4, 4};
  std::vector<int32_t> values;
  for (const Label& label : find_labels("image", image_of(PLC_I32, voxels, {2, 2, 2}))) {
    values.push_back(label.value);
  }
  CHECK(values == std::vector<int32_t>{-2147483647 - 1, -5, 4, 2147483647});
}

TEST_CASE("An image of zeros has no labels, whatever the zero's sign", "[labels]") {
  const std::vector<float> voxels = {0, -0.0F, 0, 0, 0, 0, 0, 0};
  CHECK(find_labels("image", image_of(PLC_F32, voxels, {2, 2, 2})).empty());
}

TEST_CASE("Labels that are no integers are refused in one line", "[labels]") {
  for (const float value : {0.5F, std::nanf(""), INFINITY, 3e9F, -3e9F}) {
    CAPTURE(value);
    const std::vector<float> voxels = {0, 1, 2, value, 0, 0, 0, 0};
    const plc_image image = image_of(PLC_F32, voxels, {2, 2, 2});
    const std::string message = failure_of([&] { find_labels("brain.nii", image); });
    CHECK_THAT(message, Catch::Contains("brain.nii") && Catch::Contains("integer"));
  }
}

TEST_CASE("65,535 labels are taken and one more is refused", "[labels]") {
  std::vector<int32_t> voxels(size_t{1} << 16);
  for (size_t i = 0; i < voxels.size(); ++i) voxels[i] = static_cast<int32_t>(i);
  const plc_image image = image_of(PLC_I32, voxels, {64, 32, 32});
  CHECK(find_labels("image", image).size() == 65535);
  voxels[0] = -1;
  CHECK_THAT(failure_of([&] { find_labels("image", image); }), Catch::Contains("65535"));
}

TEST_CASE("A crop holds its label only, with one voxel around it", "[labels]") {
  const std::vector<int16_t> voxels = {-7, -7, 0, 3, 0, -7, 0, 0, 0, 0, 3, 3, 3, 0, 0, 0};
  const plc_image image = image_of(PLC_I16, voxels, {4, 2, 2});
  const LabelCrop crop = crop_label(image, find_labels("image", image)[0]);
  CHECK(crop.low == Indices{-1, -1, -1});
  CHECK(crop.image.type == PLC_U8);
  CHECK(crop.image.voxels == crop.voxels.data());
  CHECK(Indices{crop.image.dims[0], crop.image.dims[1], crop.image.dims[2]} == Indices{4, 4, 3});
  std::vector<uint8_t> expected(48, 0);
  expected[1 + 4 * (1 + 4)] = 255;
  expected[2 + 4 * (1 + 4)] = 255;
  expected[2 + 4 * (2 + 4)] = 255;
  CHECK(crop.voxels == expected);
}

TEST_CASE("A crop lies where its voxels lie in the whole image", "[labels]") {
  std::vector<uint8_t> voxels(size_t{8} * 8 * 8, 0);
  voxels[4 + 8 * (5 + 8 * 6)] = 1;
  plc_image image = image_of(PLC_U8, voxels, {8, 8, 8});
  const double direction[9] = {0, 0.6, 0.8, 1, 0, 0, 0, 0.8, -0.6};
  std::copy(direction, direction + 9, image.direction);
  const double spacing[3] = {0.5, 2, 3};
  std::copy(spacing, spacing + 3, image.spacing);
  const double origin[3] = {10, 20, 30};
  std::copy(origin, origin + 3, image.origin);
  const LabelCrop crop = crop_label(image, find_labels("image", image)[0]);
  CHECK(crop.low == Indices{3, 4, 5});  // that is 1.5, 8 and 15 mm along the axes
  CHECK(crop.image.origin[0] == Approx(10 + 0.6 * 8 + 0.8 * 15));
  CHECK(crop.image.origin[1] == Approx(20 + 1.5));
  CHECK(crop.image.origin[2] == Approx(30 + 0.8 * 8 - 0.6 * 15));
  CHECK(crop.image.spacing[1] == 2);
  CHECK(crop.image.direction[8] == -0.6);
}
