#include "engine/start/thickness.h"

#include <catch2/catch.hpp>
#include <vector>

namespace {

// A plate across z: values 0, but for slices 4 .. 3 + thick, which are 1; with voxels of `voxel`
// mesh units.
struct Plate {
  Plate(int32_t thick, float voxel) : values(size_t{9} * 9 * 9, 0) {
    for (int32_t z = 4; z < 4 + thick; ++z) {
      std::fill_n(values.begin() + static_cast<ptrdiff_t>(z) * 81, 81, 1.0F);
    }
    object.image = {values.data(), {9, 9, 9}, {1 / voxel, 1 / voxel, 1 / voxel}, {0, 0, 0}, {}};
  }
  std::vector<float> values;
  plc::ImageObject object{{}, 0.25F, true};
};

float extent(const Plate& plate, const plc::Voxel& at, size_t axis, float enough) {
  return plc::extent_along(plate.object, at, axis, enough, [&](const plc::Voxel& v) {
    const float value = plc::image_value(plate.object.image, v[0], v[1], v[2]);
    return (value == 1) == (at[2] >= 4);
  });
}

}  // namespace

TEST_CASE(
    "the extent of a plate is where the image crosses iso, that of the image half a voxel more",
    "[thickness]") {
  const Plate plate(2, 0.5F);
  // From a voxel to the next the value falls from 1 to 0: three quarters of the way are inside.
  CHECK(extent(plate, {4, 4, 4}, 2, 9) == Approx(0.5 * (1 + 2 * 0.75)));
  CHECK(extent(plate, {4, 4, 5}, 2, 9) == Approx(0.5 * (1 + 2 * 0.75)));
  CHECK(extent(plate, {4, 4, 4}, 0, 9) == Approx(0.5 * 9));
  // No farther than needed.
  CHECK(extent(plate, {4, 4, 4}, 0, 1) == Approx(1));
  // Below it, from the border to a quarter of a voxel from the plate.
  CHECK(extent(plate, {4, 4, 1}, 2, 9) == Approx(0.5 * (3 + 0.5 + 0.25)));
}

TEST_CASE("what is thin on one axis is thin, object or gap", "[thickness]") {
  const Plate plate(1, 1);
  CHECK(plc::is_thin(plate.object, {4, 4, 4}, 1.51F));
  CHECK_FALSE(plc::is_thin(plate.object, {4, 4, 4}, 1.49F));
  CHECK_FALSE(plc::is_thin(plate.object, {4, 4, 2}, 2));
  plc::ImageObject gap = plate.object;
  gap.above = false;
  CHECK(plc::is_thin(gap, {4, 4, 4}, 1.51F));
  CHECK_FALSE(plc::is_thin(gap, {4, 4, 4}, 1.49F));
}
