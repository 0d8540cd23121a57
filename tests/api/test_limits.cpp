// Sizes about 2^31 and beyond at the C API: computed in 64 bits, and refused or handled, before
// memory is taken or what is not there is read.
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "engine/pellicle.h"
#include "tests/samples/address_space.h"

namespace {

constexpr int64_t kMax = std::numeric_limits<int64_t>::max();
constexpr int64_t k31 = int64_t{1} << 31;

class Host {
 public:
  explicit Host(int64_t limit = 0) {
    plc_context_options options;
    plc_context_options_defaults(&options);
    options.threads = 1;
    options.memory_limit = limit;
    REQUIRE(plc_context_create(&options, &context_, nullptr, 0) == PLC_OK);
  }
  ~Host() { plc_context_destroy(context_); }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  plc_context* get() const { return context_; }
  std::string message() const { return plc_context_message(context_); }
  int64_t peak() const {
    int64_t now = 0;
    int64_t most = 0;
    REQUIRE(plc_context_memory(context_, &now, &most) == PLC_OK);
    return most;
  }

 private:
  plc_context* context_ = nullptr;
};

plc_image image_of(plc_voxel_type type, const void* voxels, int64_t x, int64_t y, int64_t z) {
  plc_image image;
  plc_image_defaults(&image);
  image.type = type;
  image.voxels = voxels;
  const std::array<int64_t, 3> dims = {x, y, z};
  std::copy(dims.begin(), dims.end(), image.dims);
  return image;
}

plc_status create(const Host& host, const plc_image& image, plc_ownership ownership) {
  plc_volume* volume = nullptr;
  const plc_status status = plc_volume_create(host.get(), &image, ownership, &volume);
  CHECK((volume != nullptr) == (status == PLC_OK));
  plc_volume_destroy(volume);
  return status;
}

constexpr double kXyz[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
constexpr uint32_t kAbc[3] = {0, 1, 2};

}  // namespace

TEST_CASE("Images of impossible sizes are refused, their voxels are not looked at", "[limits]") {
  const Host host;
  alignas(8) const uint8_t voxel = 0;
  constexpr int64_t kSizes[][3] = {{int64_t{1} << 21, int64_t{1} << 21, int64_t{1} << 21},
                                   {int64_t{1} << 60, 2, 2},
                                   {kMax, 2, 2},
                                   {kMax, kMax, kMax},
                                   {int64_t{1} << 32, int64_t{1} << 32, 2},
                                   {-k31, -k31, 2},
                                   {std::numeric_limits<int64_t>::min(), 2, 2}};
  for (const auto& n : kSizes) {
    CAPTURE(n[0], n[1], n[2]);
    for (const plc_ownership ownership : {PLC_BORROW, PLC_COPY}) {
      CHECK(create(host, image_of(PLC_F32, &voxel, n[0], n[1], n[2]), ownership) ==
            PLC_INVALID_DATA);
      CHECK(!host.message().empty());
    }
  }
}

TEST_CASE("A copy that memory has no room for is refused before it is begun", "[limits]") {
  const Host host(int64_t{1} << 20);
  alignas(8) const uint8_t voxel = 0;
  constexpr int64_t kSizes[][3] = {{k31 - 1, 2, 2},
                                   {k31, 2, 2},
                                   {k31 + 1, 2, 2},
                                   {2, 2, k31 * 2},
                                   {int64_t{1} << 20, int64_t{1} << 20, int64_t{1} << 18}};
  for (const auto& n : kSizes) {
    CAPTURE(n[0], n[1], n[2]);
    CHECK(create(host, image_of(PLC_U8, &voxel, n[0], n[1], n[2]), PLC_COPY) == PLC_OUT_OF_MEMORY);
    plc_image apart = image_of(PLC_I16, &voxel, n[0], n[1], n[2]);
    apart.strides[0] = -2;
    apart.strides[1] = 2 * n[0] + 2;
    apart.strides[2] = apart.strides[1] * n[1];
    CHECK(create(host, apart, PLC_BORROW) == PLC_OUT_OF_MEMORY);
  }
  CHECK(host.peak() <= int64_t{1} << 20);
}

TEST_CASE("Levels of too many voxels are refused without memory for them, and nothing is read",
          "[limits]") {
  const Host host(int64_t{64} << 20);
  struct Refused {
    plc_voxel_type type;
    int64_t size[3];
  };
  // The second of each has fewer voxels than are too many, but not with what is around it.
  constexpr Refused kRefused[] = {{PLC_I32, {1300, 1300, 1300}},
                                  {PLC_I32, {1285, 1285, 1285}},
                                  {PLC_U8, {int64_t{1} << 16, int64_t{1} << 15, 2}},
                                  {PLC_U8, {(int64_t{1} << 16) - 1, (int64_t{1} << 15) - 1, 2}},
                                  {PLC_U8, {2, 2, int64_t{1} << 30}},
                                  {PLC_U8, {10321, 10321, 10321}}};
  for (const Refused& refused : kRefused) {
    const auto [x, y, z] = refused.size;
    CAPTURE(x, y, z);
    const size_t bytes = refused.type == PLC_I32 ? 4 : 1;
    const samples::AddressSpace voxels(bytes * static_cast<size_t>(x * y * z), PROT_NONE);
    const plc_image image = image_of(refused.type, voxels.data(), x, y, z);
    plc_volume* volume = nullptr;
    REQUIRE(plc_volume_create(host.get(), &image, PLC_BORROW, &volume) == PLC_OK);
    plc_parameters parameters;
    plc_parameters_defaults(&parameters);
    parameters.iso = 100;
    plc_pyramid* pyramid = nullptr;
    CHECK(plc_pyramid_create(host.get(), volume, &parameters, &pyramid) == PLC_INVALID_DATA);
    CHECK(pyramid == nullptr);
    CHECK_THAT(host.message(), Catch::Contains("2^31"));
    plc_volume_destroy(volume);
    plc_surface* surface = nullptr;
    CHECK(plc_extract(host.get(), &image, &parameters, nullptr, &surface) == PLC_INVALID_DATA);
    CHECK(surface == nullptr);
  }
}

TEST_CASE("Of an image of more than 2^31 voxels surfaces are found at both ends", "[limits]") {
  constexpr int64_t kX = 1300, kY = 1300, kZ = 1300;
  const samples::AddressSpace space(static_cast<size_t>(kX * kY * kZ), PROT_READ | PROT_WRITE);
  auto* voxels = static_cast<uint8_t*>(space.data());
  constexpr double kRadius = 25, kSoft = 3;
  const auto put_ball = [&](int64_t centre) {
    constexpr auto kReach = static_cast<int64_t>(kRadius + kSoft) + 1;
    for (int64_t z = -kReach; z <= kReach; ++z) {
      for (int64_t y = -kReach; y <= kReach; ++y) {
        for (int64_t x = -kReach; x <= kReach; ++x) {
          const double away = std::sqrt(static_cast<double>(x * x + y * y + z * z)) - kRadius;
          const double value = std::clamp(100 - away * (100 / kSoft), 0.0, 200.0);
          voxels[((centre + z) * kY + centre + y) * kX + centre + x] = static_cast<uint8_t>(value);
        }
      }
    }
  };
  put_ball(60);
  put_ball(1240);
  const Host host;
  const plc_image image = image_of(PLC_U8, voxels, kX, kY, kZ);
  plc_parameters parameters;
  plc_parameters_defaults(&parameters);
  parameters.iso = 100;
  parameters.reduction = 2;
  parameters.levels = 3;
  plc_surface* surface = nullptr;
  const plc_status status = plc_extract(host.get(), &image, &parameters, nullptr, &surface);
  CAPTURE(host.message());
  REQUIRE(status == PLC_OK);
  plc_measures measures;
  plc_measures_defaults(&measures);
  REQUIRE(plc_surface_measure(host.get(), surface, PLC_SPACE_VOXEL, &measures) == PLC_OK);
  constexpr double kBall = 4 * 3.14159265358979 / 3 * kRadius * kRadius * kRadius;
  CHECK(measures.components == 2);
  CHECK(measures.volume == Approx(2 * kBall).epsilon(0.02));
  plc_surface_destroy(surface);
}

TEST_CASE("Impossible counts of vertices and faces are refused before they are read", "[limits]") {
  const Host host;
  plc_check check{};
  check.struct_size = sizeof check;
  const int64_t impossible[] = {
      -1, std::numeric_limits<int64_t>::min(), kMax, kMax / 3, int64_t{1} << 61, int64_t{1} << 60};
  for (const int64_t count : impossible) {
    CAPTURE(count);
    CHECK(plc_check_mesh(host.get(), kXyz, count, kAbc, 1, &check) == PLC_INVALID_ARGUMENT);
    CHECK(plc_check_mesh(host.get(), kXyz, 3, kAbc, count, &check) == PLC_INVALID_ARGUMENT);
    float rounded[9] = {};
    CHECK(plc_mesh_round(host.get(), kXyz, count, kAbc, 1, rounded, nullptr) ==
          PLC_INVALID_ARGUMENT);
    double values[3] = {7, 7, 7};
    CHECK(plc_mesh_geodesic(host.get(), kXyz, count, kAbc, 1, 0, values) == PLC_INVALID_ARGUMENT);
    CHECK(plc_mesh_geodesic(host.get(), kXyz, 3, kAbc, count, 0, values) == PLC_INVALID_ARGUMENT);
    CHECK(plc_mesh_curvature(host.get(), kXyz, 3, kAbc, count, values, values, values) ==
          PLC_INVALID_ARGUMENT);
    plc_surface* surface = nullptr;
    CHECK(plc_surface_create(host.get(), PLC_SPACE_LPS, nullptr, kXyz, count, kAbc, 1, &surface) ==
          PLC_INVALID_ARGUMENT);
    CHECK(plc_surface_create(host.get(), PLC_SPACE_LPS, nullptr, kXyz, 3, kAbc, count, &surface) ==
          PLC_INVALID_ARGUMENT);
    CHECK(surface == nullptr);
    CHECK(values[0] == 7);
  }
}

TEST_CASE("Counts of seeds, places and corners of a start that cannot be are refused", "[limits]") {
  const Host host;
  const std::vector<uint8_t> voxels(1000, 1);
  const plc_image image = image_of(PLC_U8, voxels.data(), 10, 10, 10);
  plc_parameters parameters;
  plc_parameters_defaults(&parameters);
  parameters.iso = 1;
  const plc_seed seed{{5, 5, 5}, 2};
  const plc_pin pin{{5, 5, 5}, 2};
  const plc_attachment attachment{{5, 5, 5}, 2, 1};
  const auto status = [&](const plc_extras& extras, plc_init init) {
    parameters.init = init;
    plc_surface* surface = nullptr;
    const plc_status result = plc_extract(host.get(), &image, &parameters, &extras, &surface);
    CHECK(surface == nullptr);
    return result;
  };
  for (const int64_t count : {int64_t{-1}, kMax, int64_t{1} << 60}) {
    CAPTURE(count);
    plc_extras extras;
    plc_extras_defaults(&extras);
    extras.seeds = &seed;
    extras.seed_count = count;
    CHECK(status(extras, PLC_INIT_SEEDS) == PLC_INVALID_ARGUMENT);
    plc_extras_defaults(&extras);
    extras.pins = &pin;
    extras.pin_count = count;
    CHECK(status(extras, PLC_INIT_BUBBLE) == PLC_INVALID_ARGUMENT);
    plc_extras_defaults(&extras);
    extras.attachments = &attachment;
    extras.attachment_count = count;
    CHECK(status(extras, PLC_INIT_BUBBLE) == PLC_INVALID_ARGUMENT);
    plc_extras_defaults(&extras);
    extras.mesh_xyz = kXyz;
    extras.mesh_vertex_count = count;
    extras.mesh_abc = kAbc;
    extras.mesh_face_count = 1;
    CHECK(status(extras, PLC_INIT_MESH) == PLC_INVALID_ARGUMENT);
  }
}
