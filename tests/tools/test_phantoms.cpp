#include "tools/phantom/phantoms.h"

#include <catch2/catch.hpp>
#include <cstring>

#include "tests/tools/tool_fixtures.h"
#include "tools/phantom/phantoms_random.h"

namespace {

using fixtures::failure_of;
using plc::tools::full_scale;
using plc::tools::LoadedVolume;
using plc::tools::make_phantom;
using plc::tools::PhantomOptions;
using plc::tools::Random;

constexpr double kPi = 3.14159265358979323846;

// In units of full scale.
std::vector<double> values(const LoadedVolume& volume) {
  const auto unpacked = [&]<typename T>(T) {
    std::vector<T> raw(volume.bytes.size() / sizeof(T));
    std::memcpy(raw.data(), volume.bytes.data(), volume.bytes.size());
    std::vector<double> result;
    result.reserve(raw.size());
    for (const T value : raw) {
      result.push_back(static_cast<double>(value) / full_scale(volume.image.type));
    }
    return result;
  };
  switch (volume.image.type) {
    case PLC_U8:
      return unpacked(uint8_t{});
    case PLC_I16:
      return unpacked(int16_t{});
    case PLC_U16:
      return unpacked(uint16_t{});
    case PLC_I32:
      return unpacked(int32_t{});
    case PLC_F32:
      return unpacked(float{});
  }
  return {};
}

// mm3 at or above the value.
double volume_above(const LoadedVolume& volume, double iso) {
  double count = 0;
  for (const double value : values(volume)) count += value >= iso ? 1 : 0;
  return count * volume.image.spacing[0] * volume.image.spacing[1] * volume.image.spacing[2];
}

uint64_t fnv(const LoadedVolume& volume) {
  uint64_t hash = 0xcbf29ce484222325U;
  for (const std::byte byte : volume.bytes) {
    hash = (hash ^ static_cast<uint64_t>(byte)) * 0x100000001b3U;
  }
  return hash;
}

PhantomOptions cube(int64_t size) {
  PhantomOptions options;
  for (auto& side : options.size) side = size;
  return options;
}

}  // namespace

TEST_CASE("Every phantom has its default size, type and geometry", "[phantoms]") {
  struct Expected {
    const char* name;
    int64_t dims[3];
    plc_voxel_type type;
  };
  for (const Expected& expected :
       {Expected{"chain", {64, 64, 64}, PLC_F32}, Expected{"sierpinski", {81, 81, 81}, PLC_U8},
        Expected{"shell", {80, 80, 80}, PLC_U8}, Expected{"vessels", {256, 256, 124}, PLC_I16},
        Expected{"blobs", {64, 64, 64}, PLC_F32}, Expected{"labels", {64, 64, 64}, PLC_U8}}) {
    CAPTURE(expected.name);
    const LoadedVolume volume = make_phantom(expected.name, {});
    CHECK(std::equal(expected.dims, expected.dims + 3, volume.image.dims));
    CHECK(volume.image.type == expected.type);
    CHECK(volume.image.voxels == volume.bytes.data());
    CHECK(volume.image.struct_size == sizeof(plc_image));
    CHECK(volume.image.spacing[1] == 1);
    CHECK(volume.image.direction[4] == 1);
    CHECK(volume.image.origin[2] == 0);
  }
}

TEST_CASE("Phantoms are the same bits everywhere", "[phantoms]") {
  PhantomOptions options = cube(24);
  options.spacing[2] = 1.5;
  options.noise = 0.05;
  options.seed = 7;
  options.type = PLC_I16;
  const std::vector<std::pair<std::string, uint64_t>> recorded = {
      {"chain", 0x60c2f8b789ead08b}, {"sierpinski", 0xc1e4611efdbbf90b},
      {"shell", 0x832a6579a9430b7e}, {"vessels", 0xd0d5548262450b32},
      {"blobs", 0xa5303dc9adfffb66}, {"labels", 0x7507aa4d8c060ca4}};
  for (const auto& [name, hash] : recorded) {
    CAPTURE(name);
    CHECK(fnv(make_phantom(name, options)) == hash);
  }
}

TEST_CASE("The seed changes shapes and noise, and nothing else does", "[phantoms]") {
  PhantomOptions a = cube(20);
  a.noise = 0.1;
  PhantomOptions b = a;
  b.seed = 2;
  for (const std::string& name : plc::tools::phantom_names()) {
    CAPTURE(name);
    CHECK(fnv(make_phantom(name, a)) == fnv(make_phantom(name, a)));
    CHECK(fnv(make_phantom(name, a)) != fnv(make_phantom(name, b)));
  }
}

TEST_CASE("The chain's rings have the volume of their tori", "[phantoms]") {
  const double exact = 4 * kPi * kPi * 14 * 3.57 * 3.57;  // two of 2 pi^2 R r^2
  CHECK(volume_above(make_phantom("chain", {}), 0.5) == Approx(exact).epsilon(0.01));
  PhantomOptions options;  // the same in mm on another grid
  options.size[0] = 128;
  options.size[1] = 64;
  options.size[2] = 32;
  options.spacing[0] = 0.5;
  options.spacing[2] = 2;
  CHECK(volume_above(make_phantom("chain", options), 0.5) == Approx(exact).epsilon(0.05));
}

TEST_CASE("The chain's potential falls linearly from the rings' circles", "[phantoms]") {
  const std::vector<double> field = values(make_phantom("chain", {}));
  // The centre of the volume is at 31.5 voxels, the circle in xy about 24.5: 0.5 mm above the plane
  // z = 31 and its point nearest to (39, 31) at distance 14.
  const double beside = std::sqrt(14.5 * 14.5 + 0.5 * 0.5) - 14;
  const double d = std::sqrt(beside * beside + 0.25);
  CHECK(field[39 + 64 * (31 + 64 * 31)] == Approx(1 - d / (2 * 3.57)).margin(1e-6));
  CHECK(field[0] == 0);
}

TEST_CASE("The sponge has 20 cells for each of the level above", "[phantoms]") {
  for (int depth = 1; depth <= 4; ++depth) {
    PhantomOptions options;
    options.depth = depth;
    CHECK(volume_above(make_phantom("sierpinski", options), 0.5) == std::pow(20, depth));
  }
  PhantomOptions stretched = cube(27);
  stretched.depth = 2;
  CHECK(volume_above(make_phantom("sierpinski", stretched), 0.5) == 27 * 400);
}

TEST_CASE("The shell is brightest on its sphere", "[phantoms]") {
  PhantomOptions options;
  options.noise = 0;
  options.type = PLC_F32;
  const LoadedVolume volume = make_phantom("shell", options);
  // (1 - t^2)^2 = 1/2 at t = sqrt(1 - sqrt(1/2)), t = 1 at 4 mm from the radius 28.8.
  const double half = 4 * std::sqrt(1 - std::sqrt(0.5));
  const double outer = 28.8 + half;
  const double inner = 28.8 - half;
  const double exact = 4.0 / 3 * kPi * (outer * outer * outer - inner * inner * inner);
  CHECK(volume_above(volume, 0.5) == Approx(exact).epsilon(0.01));
  CHECK(values(volume)[40 + 80 * (40 + 80 * 40)] == 0);
}

TEST_CASE("Vessels are bright tubes on a darker ground", "[phantoms]") {
  PhantomOptions options;
  options.noise = 0;
  const LoadedVolume volume = make_phantom("vessels", options);
  const std::vector<double> field = values(volume);
  CHECK(*std::min_element(field.begin(), field.end()) == 0.2);
  CHECK(*std::max_element(field.begin(), field.end()) == 0.8);
  const double share = volume_above(volume, 0.5) / static_cast<double>(field.size());
  CHECK(share > 0.005);
  CHECK(share < 0.1);
}

TEST_CASE("The labels are cells of a ball and one more inside a cell", "[phantoms]") {
  for (const plc_voxel_type type : {PLC_U8, PLC_I16, PLC_U16, PLC_I32, PLC_F32}) {
    CAPTURE(type);
    PhantomOptions options;
    options.count = 5;
    options.type = type;
    options.size[2] = 40;
    options.spacing[2] = 1.6;
    const LoadedVolume volume = make_phantom("labels", options);
    std::vector<int> labels;
    std::vector<int> counts(7, 0);
    for (const double value : values(volume)) {
      labels.push_back(static_cast<int>(std::lround(value * full_scale(type))));
      REQUIRE((labels.back() >= 0 && labels.back() <= 6));
      ++counts[static_cast<size_t>(labels.back())];
    }
    CHECK(*std::min_element(counts.begin(), counts.end()) > 0);
    const double ball = 4.0 / 3 * kPi * 28.8 * 28.8 * 28.8;
    CHECK((64 * 64 * 40 - counts[0]) * 1.6 == Approx(ball).epsilon(0.01));
    // The inner label's neighbours are itself and one other.
    int other = 0;
    for (size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] != 6) continue;
      for (const size_t step : {size_t{1}, size_t{64}, size_t{64} * 64}) {
        for (const int next : {labels[i - step], labels[i + step]}) {
          if (next == 6) continue;
          CHECK_FALSE((next == 0 || (other != 0 && next != other)));
          other = next;
        }
      }
    }
  }
}

TEST_CASE("Noise has the mean and the deviation asked for", "[phantoms]") {
  Random random(3);
  double sum = 0;
  double squares = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    CHECK_FALSE((value < -6 || value > 6));
    sum += value;
    squares += value * value;
  }
  CHECK(sum / kCount == Approx(0).margin(0.01));
  CHECK(squares / kCount == Approx(1).epsilon(0.02));
}

TEST_CASE("Values beyond the type's range are clamped", "[phantoms]") {
  PhantomOptions options = cube(12);
  options.noise = 100;
  for (const plc_voxel_type type : {PLC_U8, PLC_I16, PLC_U16, PLC_I32}) {
    options.type = type;
    const std::vector<double> field = values(make_phantom("blobs", options));
    if (type == PLC_U8) CHECK(*std::max_element(field.begin(), field.end()) == 1);
    if (type == PLC_U8 || type == PLC_U16) {
      CHECK(*std::min_element(field.begin(), field.end()) == 0);
    }
  }
}

TEST_CASE("Absurd options give one line", "[phantoms]") {
  const auto message = [](const char* name, const PhantomOptions& options) {
    return failure_of([&] { make_phantom(name, options); });
  };
  CHECK_THAT(message("cube", {}), Catch::Contains("unknown phantom"));
  CHECK_THAT(message("chain", cube(1)), Catch::Contains("not a volume"));
  CHECK_THAT(message("chain", cube(-3)), Catch::Contains("no voxels"));
  CHECK_THAT(message("chain", cube(100000)), Catch::Contains("of memory"));
  CHECK_THAT(message("chain", cube(int64_t{1} << 40)), Catch::Contains("too large"));
  PhantomOptions options;
  options.spacing[1] = 0;
  CHECK_THAT(message("shell", options), Catch::Contains("spacing"));
  options = {};
  options.noise = -1;
  CHECK_THAT(message("shell", options), Catch::Contains("noise"));
  options = {};
  options.count = 0;
  CHECK_THAT(message("blobs", options), Catch::Contains("number of blobs"));
  CHECK_THAT(message("labels", options), Catch::Contains("number of cells"));
  options.count = 255;  // and one more, which u8 does not hold
  CHECK_THAT(message("labels", options), Catch::Contains("within 1 .. 254"));
  options = {};
  options.depth = 40;
  CHECK_THAT(message("sierpinski", options), Catch::Contains("depth"));
}
