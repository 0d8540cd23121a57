// tools/volume/volume_box.h, and where it lies: tools/volume/volume_frame.h.
#include "tools/volume/volume_box.h"

#include <algorithm>
#include <cstring>

#include "tests/tools/tool_fixtures.h"
#include "tools/volume/volume_frame.h"
#include "tools/volume/volume_io_memory.h"

namespace {

using fixtures::failure_of;
using plc::tools::cut_out;
using plc::tools::LoadedVolume;
using plc::tools::lps_of;
using plc::tools::Place;
using plc::tools::voxel_of;

// Of 7 x 6 x 5 voxels whose values are their numbers, leaning, and of sides of three lengths.
LoadedVolume numbered() {
  const int64_t dims[3] = {7, 6, 5};
  LoadedVolume volume = plc::tools::make_volume("image", PLC_U16, dims);
  constexpr uint16_t kCount = 7 * 6 * 5;
  for (uint16_t i = 0; i < kCount; ++i) std::memcpy(volume.bytes.data() + 2 * i, &i, sizeof i);
  const double direction[9] = {0.8, 0.6, 0, -0.6, 0.8, 0, 0, 0, -1};
  const double spacing[3] = {0.5, 2, 3};
  const double origin[3] = {10, -20, 30};
  std::copy_n(direction, 9, volume.image.direction);
  std::copy_n(spacing, 3, volume.image.spacing);
  std::copy_n(origin, 3, volume.image.origin);
  return volume;
}

uint16_t value_at(const LoadedVolume& volume, size_t index) {
  uint16_t value = 0;
  std::memcpy(&value, volume.bytes.data() + 2 * index, sizeof value);
  return value;
}

}  // namespace

TEST_CASE("A box has the voxels that it names, where they were", "[volume_box]") {
  const LoadedVolume whole = numbered();
  const LoadedVolume part = cut_out("image", whole, {{2, 1, 3}, {4, 5, 4}});
  CHECK(std::vector<int64_t>(part.image.dims, part.image.dims + 3) ==
        std::vector<int64_t>{3, 5, 2});
  size_t index = 0;
  for (size_t z = 3; z <= 4; ++z) {
    for (size_t y = 1; y <= 5; ++y) {
      for (size_t x = 2; x <= 4; ++x) CHECK(value_at(part, index++) == (z * 6 + y) * 7 + x);
    }
  }
  const Place there = lps_of(part.image, {1, 2, 1});
  const Place before = lps_of(whole.image, {3, 3, 4});
  for (size_t k = 0; k < 3; ++k) CHECK(there[k] == Approx(before[k]));
}

TEST_CASE("A box that is none, or not within the image, is refused", "[volume_box]") {
  const LoadedVolume whole = numbered();
  for (const auto& [low, high] : {std::pair<Place, Place>{{-1, 0, 0}, {3, 3, 3}},
                                  {{0, 0, 0}, {7, 3, 3}},
                                  {{3, 0, 0}, {3, 3, 3}},
                                  {{0, 0, 3}, {3, 3, 2}}}) {
    plc::tools::VoxelBox box{};
    for (size_t k = 0; k < 3; ++k) {
      box.low[k] = static_cast<int64_t>(low[k]);
      box.high[k] = static_cast<int64_t>(high[k]);
    }
    CHECK_THAT(failure_of([&] { cut_out("a.nii", whole, box); }),
               Catch::Contains("a.nii: the box ") && Catch::Contains("7 x 6 x 5"));
  }
}

TEST_CASE("Places go from voxels to LPS and back", "[volume_box]") {
  plc_image image = numbered().image;
  const Place lps = lps_of(image, {2, 3, 4});
  CHECK(lps[0] == Approx(10 + 0.8 * 1 + 0.6 * 6));
  CHECK(lps[1] == Approx(-20 - 0.6 * 1 + 0.8 * 6));
  CHECK(lps[2] == Approx(30 - 12));
  image.direction[1] = 0.7;  // sheared
  const Place back = voxel_of(image, lps_of(image, {2, 3, 4}));
  for (size_t k = 0; k < 3; ++k) CHECK(back[k] == Approx(static_cast<double>(k) + 2));
}

TEST_CASE("Axes are told by their letters, obliquity and bounds", "[volume_box]") {
  const plc_image image = numbered().image;
  CHECK(plc::tools::axis_letters(image) == "LPI");
  CHECK(plc::tools::obliquity(image) == Approx(36.8699).epsilon(1e-5));
  const plc::tools::Bounds bounds = plc::tools::bounds_of(image);
  CHECK(bounds.low[0] == Approx(10));
  CHECK(bounds.high[0] == Approx(10 + 0.8 * 3 + 0.6 * 10));
  CHECK(bounds.low[2] == Approx(18));
  CHECK(bounds.high[2] == Approx(30));
}
