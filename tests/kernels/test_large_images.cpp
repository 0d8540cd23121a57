// Images of more voxels than 32 bits number, of which memory holds a few.
#include <sys/mman.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "kernels/image_force.h"
#include "kernels/scalar.h"
#include "tests/samples/address_space.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/typed_images.h"

namespace {

using namespace fixtures;
using plc::Float4;
using plc::ImageView;
using plc::SimdTarget;

constexpr int32_t kSide = 1700;  // kSide^3 > 2^32
constexpr int32_t kPart = 12;
constexpr int32_t kPad = 3;

// The part at the low or the high end of each axis, as bits of `corner` say.
int32_t first_of_part(int32_t corner, int32_t axis) {
  return (corner >> axis & 1) != 0 ? kSide - kPart : 0;
}

// Copies the voxels of the part to its place in the large image.
template <typename Voxel>
void put(const TypedImage<Voxel>& part, int32_t corner, Voxel* large) {
  const int32_t first[3] = {first_of_part(corner, 0), first_of_part(corner, 1),
                            first_of_part(corner, 2)};
  for (int32_t z = 0; z < kPart; ++z) {
    for (int32_t y = 0; y < kPart; ++y) {
      const auto row =
          static_cast<size_t>(first[2] + z) * kSide + static_cast<size_t>(first[1] + y);
      const auto* from = part.voxels.data() + (z * kPart + y) * kPart;
      std::copy_n(from, kPart, large + row * kSide + static_cast<size_t>(first[0]));
    }
  }
}

// Inside the part and beyond that end of each axis at which it lies. In steps of 1/64, which keep
// their fractions wherever in the large image they lie.
std::vector<Float4> places_of(int32_t corner, uint32_t count, uint32_t seed) {
  const std::vector<float> v = random_floats(size_t{count} * 3, 0.0F, 1.0F, seed);
  std::vector<Float4> all(count);
  for (uint32_t i = 0; i < count; ++i) {
    const auto at = [&](int32_t axis) {
      const bool high = (corner >> axis & 1) != 0;
      const float begin = high ? kPad : -1, end = high ? kPart + 2 * kPad : kPart + kPad - 1;
      const float p = begin + (end - begin) * v[3 * i + static_cast<uint32_t>(axis)];
      return std::floor(p * 64) / 64;
    };
    all[i] = {at(0), at(1), at(2), 0};
  }
  return all;
}

}  // namespace

TEMPLATE_TEST_CASE(
    "an image of more than 2^32 voxels is sampled as parts of it are on every target", "[kernels]",
    uint8_t, int16_t, uint16_t) {
  constexpr size_t kVoxels = size_t{kSide} * kSide * kSide;
  const samples::AddressSpace space(kVoxels * sizeof(TestType), PROT_READ | PROT_WRITE);
  auto* large = static_cast<TestType*>(space.data());
  for (int32_t corner = 0; corner < 8; ++corner) {
    const TypedImage<TestType> part(kPart, kPart, kPart, kPad, 5 + static_cast<uint32_t>(corner));
    put(part, corner, large);
    ImageView view = part.view;
    view.data = large;
    for (int32_t a = 0; a < 3; ++a) {
      view.dims[a] = kSide + 2 * kPad;
      view.offset[a] = static_cast<float>(first_of_part(corner, a));
    }
    const std::vector<Float4> position = places_of(corner, 163, 40 + static_cast<uint32_t>(corner));
    const auto count = static_cast<uint32_t>(position.size());
    std::vector<float> expected(count), twin(count);
    plc::kernels::scalar::sample_trilinear(part.view, position.data(), 0, count, expected.data());
    plc::kernels::scalar::sample_trilinear(view, position.data(), 0, count, twin.data());
    CAPTURE(corner);
    REQUIRE(first_difference(twin, expected) == -1);
    for (const SimdTarget simd : plc::available_simd_targets()) {
      std::vector<float> got(count);
      plc::kernels::sample_trilinear(simd, view, position.data(), 0, count, got.data());
      CAPTURE(plc::simd_target_name(simd));
      REQUIRE(first_difference(got, expected) == -1);
    }
  }
}
