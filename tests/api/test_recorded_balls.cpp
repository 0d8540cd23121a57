// The extraction that tests/wasm/test_wasm.mjs asks of the package for JavaScript, as hosts in C
// have it: one recorded hash for both.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"

namespace {

constexpr int64_t kDims[3] = {44, 36, 32};
constexpr uint64_t kHash = 0x3a1e62066a367129;

std::vector<int16_t> balls() {
  std::vector<int16_t> voxels;
  for (int z = 0; z < kDims[2]; ++z) {
    for (int y = 0; y < kDims[1]; ++y) {
      for (int x = 0; x < kDims[0]; ++x) {
        const auto squared = [&](int cx) {
          return (x - cx) * (x - cx) + (y - 17) * (y - 17) + (z - 15) * (z - 15);
        };
        const int nearer = std::min(squared(15), squared(28));
        voxels.push_back(static_cast<int16_t>(std::max(0, 1000 - 4 * nearer)));
      }
    }
  }
  return voxels;
}

}  // namespace

TEST_CASE("two balls that overlap have the hash that the package for JavaScript gives",
          "[pellicle]") {
  const std::vector<int16_t> voxels = balls();
  plc_image image;
  plc_image_defaults(&image);
  image.type = PLC_I16;
  image.voxels = voxels.data();
  std::copy_n(kDims, 3, image.dims);
  image.spacing[2] = 1.25;
  plc_parameters p;
  plc_parameters_defaults(&p);
  p.iso = 600;
  p.levels = 1;
  p.max_iterations = 60;
  const samples::Context context = samples::make_context();
  plc_surface* surface = nullptr;
  REQUIRE(plc_extract(context.get(), &image, &p, nullptr, &surface) == PLC_OK);
  CHECK(plc_surface_hash(surface) == kHash);
  plc_surface_destroy(surface);
}
