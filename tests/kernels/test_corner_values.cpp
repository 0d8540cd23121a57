// Values of which instruction sets have different opinions: the sign of zero, what is no number,
// what fits no integer. Every target has those of the scalar twin, and they are written down here.
#include <array>
#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "kernels/face_pairs.h"
#include "kernels/image_force.h"
#include "kernels/image_rows.h"
#include "kernels/simd.h"
#include "kernels/voxels.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/typed_images.h"

namespace {

using plc::SimdTarget;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kLargest = std::numeric_limits<float>::max();
constexpr size_t kSide = 17;  // whole vectors of every target, and a rest

uint32_t bits(float value) {
  uint32_t same;
  std::memcpy(&same, &value, sizeof same);
  return same;
}

// An image of one voxel value.
template <typename Voxel>
struct EvenImage {
  std::vector<Voxel> voxels;
  plc::ImageView view;
  EvenImage(Voxel value, float low, float scale) : voxels(kSide * kSide * kSide, value) {
    view.data = voxels.data();
    for (int32_t& dim : view.dims) dim = kSide;
    view.form = {fixtures::image_type<Voxel>(), 0, 0, low, scale};
  }
};

// The value of every voxel of an even image, on every target, by rows and by sampling.
template <typename Voxel>
void check_value(Voxel voxel, float low, float scale, float expected) {
  const EvenImage<Voxel> image(voxel, low, scale);
  const std::vector<plc::Float4> place(plc::kRingLanes, plc::Float4{3.5F, 4.5F, 5.5F, 0});
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd), static_cast<float>(voxel), low, scale);
    std::vector<float> values(kSide, fixtures::kUntouched);
    plc::kernels::image_rows(simd, image.view, 2, 1, 2, values.data());
    for (const float value : values) CHECK(bits(value) == bits(expected));
    values.assign(plc::kRingLanes, fixtures::kUntouched);
    plc::kernels::sample_trilinear(simd, image.view, place.data(), 0, plc::kRingLanes,
                                   values.data());
    for (const float value : values) CHECK(bits(value) == bits(expected));
  }
}

}  // namespace

TEST_CASE("a voxel at the window's dark end is +0, whichever way the window runs", "[kernels]") {
  check_value<uint8_t>(7, 7, -1, 0.0F);
  check_value<int16_t>(-7, -7, -1, 0.0F);
  check_value<uint16_t>(7, 7, -1, 0.0F);
  check_value<float>(7, 7, -1, 0.0F);
  check_value<float>(-0.0F, 0, 1, 0.0F);
}

TEST_CASE("a voxel that a window without width makes no number is dark", "[kernels]") {
  check_value<uint8_t>(7, 7, kInfinity, 0.0F);
  check_value<int16_t>(7, 7, kInfinity, 0.0F);
  check_value<uint16_t>(7, 7, kInfinity, 0.0F);
  check_value<float>(7, 7, kInfinity, 0.0F);
  check_value<uint8_t>(8, 7, kInfinity, 1.0F);
  check_value<uint8_t>(6, 7, kInfinity, 0.0F);
}

TEST_CASE("a byte above 127 and the ends of the 16-bit types are what they are", "[kernels]") {
  check_value<uint8_t>(255, 0, 1.0F / 256, 255.0F / 256);
  check_value<uint8_t>(128, 0, 1.0F / 256, 0.5F);
  check_value<int16_t>(-32768, -65536, 1.0F / 65536, 0.5F);
  check_value<uint16_t>(65535, 0, 1.0F / 65536, 65535.0F / 65536);
}

TEST_CASE("places that fit no integer are those of the nearest voxel", "[kernels]") {
  std::vector<float> ramp(kSide * kSide * kSide);
  for (size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<float>(i % kSide) / 32;
  plc::ImageView image;
  image.data = ramp.data();
  for (int32_t& dim : image.dims) dim = kSide;
  const float last = static_cast<float>(kSide - 1) / 32;
  const std::pair<float, float> places[] = {{kInfinity, last}, {-kInfinity, 0},  {kNan, 0},
                                            {-kNan, 0},        {kLargest, last}, {-kLargest, 0},
                                            {0x1p31F, last},   {-0x1.8p31F, 0},  {0x1p32F, last},
                                            {0x1p63F, last},   {-0.0F, 0},       {-0x1p-149F, 0}};
  for (const auto& [x, expected] : places) {
    const std::vector<plc::Float4> at(plc::kRingLanes, plc::Float4{x, 3, 3, 0});
    for (const SimdTarget simd : plc::available_simd_targets()) {
      std::vector<float> values(plc::kRingLanes);
      plc::kernels::sample_trilinear(simd, image, at.data(), 0, plc::kRingLanes, values.data());
      CAPTURE(plc::simd_target_name(simd), x);
      for (const float value : values) CHECK(bits(value) == bits(expected));
    }
  }
}

TEST_CASE("voxels become values alike at the ends of their types", "[kernels]") {
  constexpr auto kLow = std::numeric_limits<int32_t>::min();
  constexpr auto kHigh = std::numeric_limits<int32_t>::max();
  std::vector<int32_t> voxels(2 * kSide);
  for (size_t i = 0; i < voxels.size(); ++i) voxels[i] = i % 2 == 0 ? kLow : kHigh;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    std::vector<float> values(voxels.size());
    plc::kernels::normalize_voxels(simd, plc::VoxelType::kI32, voxels.data(), voxels.size(),
                                   -0x1p32, 0x1p-33, values.data());
    for (size_t i = 0; i < values.size(); ++i) CHECK(values[i] == (i % 2 == 0 ? 0.25F : 0.75F));
    const plc::kernels::VoxelExtent extent =
        plc::kernels::voxel_extent(simd, plc::VoxelType::kI32, voxels.data(), voxels.size());
    CHECK(extent.low == static_cast<double>(kLow));
    CHECK(extent.high == static_cast<double>(kHigh));
  }
}

TEST_CASE("values that round to no float or to a small one round alike", "[kernels]") {
  // Halves of the last place, which go to the even one; below the smallest float with all its
  // digits.
  const std::vector<float> voxels(kSide, 1);
  const std::pair<double, float> products[] = {{0x1.000001p-1, 0x1p-1F},
                                               {0x1.000003p-1, 0x1.000004p-1F},
                                               {0x1.000001p-130, 0x1p-130F},
                                               {0x1p-149, 0x1p-149F},
                                               {0x1p-150, 0.0F},
                                               {0x1.8p-150, 0x1p-149F},
                                               {0x1p-1074, 0.0F}};
  for (const auto& [scale, expected] : products) {
    for (const SimdTarget simd : plc::available_simd_targets()) {
      std::vector<float> values(voxels.size());
      plc::kernels::normalize_voxels(simd, plc::VoxelType::kF32, voxels.data(), voxels.size(), 0,
                                     scale, values.data());
      CAPTURE(plc::simd_target_name(simd), scale);
      for (const float value : values) CHECK(bits(value) == bits(expected));
    }
  }
}

TEST_CASE("boxes that touch in a zero of either sign overlap on every target", "[kernels]") {
  constexpr uint32_t kFaces = 2 * plc::BoxLanes::kLanes;
  std::array<uint32_t, 3 * kFaces> corners{};
  std::iota(corners.begin(), corners.end(), 0U);
  const plc::Box3 nowhere{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
  for (const float zero : {0.0F, -0.0F}) {
    // Two leaves of one face each; the second begins where the first ends.
    const std::array<plc::Box3, 2> boxes = {
        {{{-1, -1, -1}, {zero, zero, zero}}, {{-zero, zero, -zero}, {1, 1, 1}}}};
    std::array<plc::BoxLanes, 2> leaves;
    plc::BoxLanes node;
    for (uint32_t k = 0; k < plc::BoxLanes::kLanes; ++k) {
      node.set(k, k < 2 ? boxes[k] : nowhere);
      for (size_t l = 0; l < 2; ++l) leaves[l].set(k, k == 0 ? boxes[l] : nowhere);
    }
    const std::array<uint8_t, 2> leaf_moved{1, 1};
    const uint8_t node_moved = 3;
    const plc::kernels::FaceBoxes tree{corners.data(), leaves.data(), leaf_moved.data(), &node,
                                       &node_moved};
    for (const SimdTarget simd : plc::available_simd_targets()) {
      CAPTURE(plc::simd_target_name(simd), zero);
      std::vector<plc::kernels::CandidatePair> pairs(plc::kernels::kMostPairs);
      const uint32_t own = 0;
      REQUIRE(plc::kernels::face_pairs(simd, tree, 0, &own, 1, pairs.data()) == 1);
      CHECK(pairs[0].f == 0);
      CHECK(pairs[0].g == plc::BoxLanes::kLanes);
    }
  }
}
