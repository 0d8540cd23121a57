// Volumes of the C API: layouts, ownership, sizes.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/sample_api.h"
#include "tests/samples/sample_hosts.h"

namespace {

using Catch::Matchers::Contains;
using samples::Context;
using samples::VolumeHandle;

VolumeHandle volume_of(plc_context* context, const plc_image& image, plc_ownership ownership) {
  plc_volume* volume = nullptr;
  const plc_status status = plc_volume_create(context, &image, ownership, &volume);
  INFO(plc_context_message(context));
  REQUIRE(status == PLC_OK);
  return VolumeHandle(volume);
}

plc_image image_in(plc_context* context, const plc_volume* volume) {
  plc_image image;
  plc_image_defaults(&image);
  REQUIRE(plc_volume_image(context, volume, &image) == PLC_OK);
  return image;
}

std::string refused(plc_context* context, const plc_image& image, plc_status expected) {
  plc_volume* volume = nullptr;
  CHECK(plc_volume_create(context, &image, PLC_BORROW, &volume) == expected);
  CHECK(volume == nullptr);
  return plc_context_message(context);
}

// A block of int16 with every voxel different.
struct Block {
  std::vector<int16_t> voxels = std::vector<int16_t>(5 * 4 * 3);
  Block() {
    for (size_t i = 0; i < voxels.size(); ++i) voxels[i] = static_cast<int16_t>(i);
  }
  plc_image image() const {
    plc_image image;
    plc_image_defaults(&image);
    image.type = PLC_I16;
    image.voxels = voxels.data();
    image.dims[0] = 5, image.dims[1] = 4, image.dims[2] = 3;
    return image;
  }
};

int16_t voxel(const plc_image& image, int64_t x, int64_t y, int64_t z) {
  return static_cast<const int16_t*>(image.voxels)[(z * image.dims[1] + y) * image.dims[0] + x];
}

}  // namespace

TEST_CASE("a volume borrows what is dense, and copies what is asked for or has gaps",
          "[pellicle_volume]") {
  const Context context = samples::make_context(2);
  const Block block;
  plc_image image = block.image();
  const VolumeHandle borrowed = volume_of(context.get(), image, PLC_BORROW);
  CHECK(image_in(context.get(), borrowed.get()).voxels == block.voxels.data());
  image.strides[0] = 2, image.strides[1] = 10, image.strides[2] = 40;
  const VolumeHandle dense = volume_of(context.get(), image, PLC_BORROW);
  CHECK(image_in(context.get(), dense.get()).voxels == block.voxels.data());
  const VolumeHandle copied = volume_of(context.get(), image, PLC_COPY);
  const plc_image copy = image_in(context.get(), copied.get());
  CHECK(copy.voxels != block.voxels.data());
  CHECK(std::memcmp(copy.voxels, block.voxels.data(), 2 * block.voxels.size()) == 0);
  for (const int64_t stride : copy.strides) CHECK(stride == 0);
}

TEST_CASE("strides reach voxels in any order, backwards, with gaps or again and again",
          "[pellicle_volume]") {
  const Context context = samples::make_context(2);
  const Block block;
  plc_image image = block.image();
  // z fastest: the block seen as 3 x 4 x 5.
  std::swap(image.dims[0], image.dims[2]);
  image.strides[0] = 40, image.strides[1] = 10, image.strides[2] = 2;
  const VolumeHandle turned = volume_of(context.get(), image, PLC_BORROW);
  CHECK(voxel(image_in(context.get(), turned.get()), 2, 1, 4) == voxel(block.image(), 4, 1, 2));
  // Mirrored along x.
  image = block.image();
  image.voxels = block.voxels.data() + 4;
  image.strides[0] = -2, image.strides[1] = 10, image.strides[2] = 40;
  const VolumeHandle mirrored = volume_of(context.get(), image, PLC_BORROW);
  CHECK(voxel(image_in(context.get(), mirrored.get()), 0, 3, 1) == voxel(block.image(), 4, 3, 1));
  // Every other voxel; and one plane for all.
  image = block.image();
  image.dims[0] = 2;
  image.strides[0] = 4, image.strides[1] = 10, image.strides[2] = 0;
  const VolumeHandle sparse = volume_of(context.get(), image, PLC_BORROW);
  CHECK(voxel(image_in(context.get(), sparse.get()), 1, 2, 2) == voxel(block.image(), 2, 2, 0));
}

TEST_CASE("an image with strides gives the same surface as the dense one", "[pellicle_volume]") {
  const Context context = samples::make_context();
  const samples::Volume volume = samples::ball({20, 18, 16});
  const plc_image dense = samples::image_of(volume);
  std::vector<float> turned(volume.values.size());
  for (size_t z = 0; z < 16; ++z) {
    for (size_t y = 0; y < 18; ++y) {
      for (size_t x = 0; x < 20; ++x) {
        turned[(x * 18 + y) * 16 + z] = volume.values[(z * 18 + y) * 20 + x];
      }
    }
  }
  plc_image image = dense;
  image.voxels = turned.data();
  image.strides[0] = 4 * 18 * 16, image.strides[1] = 4 * 16, image.strides[2] = 4;
  const plc_parameters p = samples::parameters(0.5, 1);
  CHECK(plc_surface_hash(samples::extract(context.get(), image, p).get()) ==
        plc_surface_hash(samples::extract(context.get(), dense, p).get()));
}

TEST_CASE("sizes and strides beyond any memory are refused before it is touched",
          "[pellicle_volume]") {
  const Context context = samples::make_context();
  const Block block;
  plc_image image = block.image();
  image.dims[0] = image.dims[1] = image.dims[2] = int64_t{1} << 31U;
  CHECK_THAT(refused(context.get(), image, PLC_INVALID_DATA), Contains("more than any memory"));
  image = block.image();
  image.dims[2] = std::numeric_limits<int64_t>::max();
  CHECK_THAT(refused(context.get(), image, PLC_INVALID_DATA), Contains("more than any memory"));
  image = block.image();
  image.strides[0] = 2, image.strides[1] = int64_t{1} << 62U;
  CHECK_THAT(refused(context.get(), image, PLC_INVALID_ARGUMENT), Contains("stride"));
  image.strides[1] = 11;
  CHECK_THAT(refused(context.get(), image, PLC_INVALID_ARGUMENT), Contains("no multiple"));
  image = block.image();
  image.voxels = reinterpret_cast<const char*>(block.voxels.data()) + 1;
  CHECK_THAT(refused(context.get(), image, PLC_INVALID_ARGUMENT), Contains("aligned"));
  image = block.image();
  image.dims[1] = 1;
  CHECK_THAT(refused(context.get(), image, PLC_INVALID_DATA), Contains("5 x 1 x 3"));
  image.dims[1] = -4;
  CHECK_THAT(refused(context.get(), image, PLC_INVALID_DATA), Contains("at least 2"));
}

TEST_CASE("2^31 voxels and more are refused by the pyramid without an image's memory",
          "[pellicle_volume]") {
  // One plane of voxels stands for all: nothing of that size is there.
  plc_context_options options;
  plc_context_options_defaults(&options);
  options.memory_limit = int64_t{1} << 28U;
  plc_context* made = nullptr;
  REQUIRE(plc_context_create(&options, &made, nullptr, 0) == PLC_OK);
  const Context context(made);
  const std::vector<uint8_t> row(4096);
  plc_image image;
  plc_image_defaults(&image);
  image.voxels = row.data();
  image.dims[0] = 4096, image.dims[1] = 4096, image.dims[2] = 128;
  image.strides[0] = 1;
  plc_volume* volume = nullptr;
  CHECK(plc_volume_create(context.get(), &image, PLC_BORROW, &volume) == PLC_OUT_OF_MEMORY);
  CHECK(std::string(plc_context_message(context.get())) ==
        "out of memory: 2049 MiB were asked for, 0 bytes are in use, the limit is 256 MiB");
  int64_t now = -1;
  REQUIRE(plc_context_memory(context.get(), &now, nullptr) == PLC_OK);
  CHECK(now == 0);
}

TEST_CASE("the range of a volume; NaN voxels are told", "[pellicle_volume]") {
  const Context context = samples::make_context();
  const Block block;
  const VolumeHandle volume = volume_of(context.get(), block.image(), PLC_BORROW);
  double low = -1, high = -1;
  REQUIRE(plc_volume_range(context.get(), volume.get(), &low, &high) == PLC_OK);
  CHECK(low == 0);
  CHECK(high == 59);
  samples::Volume ball = samples::ball({8, 8, 8});
  ball.values[5] = std::numeric_limits<float>::quiet_NaN();
  const plc_image image = samples::image_of(ball);
  const VolumeHandle holed = volume_of(context.get(), image, PLC_BORROW);
  CHECK(plc_volume_range(context.get(), holed.get(), &low, &high) == PLC_INVALID_DATA);
  CHECK_THAT(plc_context_message(context.get()), Contains("1 voxels are NaN"));
  CHECK(high == 59);
  plc_pyramid* pyramid = nullptr;
  const plc_parameters p = samples::parameters(0.5, 0);
  CHECK(plc_pyramid_create(context.get(), holed.get(), &p, &pyramid) == PLC_INVALID_DATA);
  CHECK(pyramid == nullptr);
}
