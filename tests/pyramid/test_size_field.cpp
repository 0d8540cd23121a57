#include "pyramid/size_field.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "engine/base/schedule.h"
#include "tests/samples/sample_surfaces.h"
#include "tests/samples/sample_volumes.h"

namespace {

constexpr int kSide = 48;
constexpr float kMiddle = 23.5F;

// A voxel of 0.8 mesh units, from the origin on.
struct Image {
  std::vector<float> values;
  plc::ImageView view() const {
    return {values.data(), {kSide, kSide, kSide}, {1.25F, 1.25F, 1.25F}, {0, 0, 0}, {}};
  }
};

// distance: to the surface in voxels, > 0 inside.
template <typename Distance>
Image image_of(const Distance& distance) {
  Image image;
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const float d =
            distance(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
        image.values.push_back(std::clamp(0.5F + 0.2F * d, 0.0F, 1.0F));
      }
    }
  }
  return image;
}

Image ball(float radius) {
  return image_of([=](float x, float y, float z) {
    return radius - std::hypot(std::hypot(x - kMiddle, y - kMiddle), z - kMiddle);
  });
}

plc::SizeField field_of(const Image& image, const plc::SizeSpec& spec = {},
                        const plc::Executor& executor = samples::kSerial) {
  plc::SizeField field;
  REQUIRE(field.build(image.view(), 0.5F, 1, spec, executor).message() == "");
  return field;
}

// At a place in voxels.
float at(const plc::SizeField& field, float x, float y, float z) {
  return 1 + field.above_delta(x * 0.8F, y * 0.8F, z * 0.8F);
}

}  // namespace

TEST_CASE("flat parts are meshed as coarsely as is asked for, whatever their direction",
          "[size_field]") {
  for (const float tilt : {0.0F, 0.3F, 1.0F}) {
    const float norm = std::sqrt(1 + 1.09F * tilt * tilt);
    const Image plane = image_of([=](float x, float y, float z) {
      return (x - kMiddle + tilt * (y - kMiddle) + 0.3F * tilt * (z - kMiddle)) / norm;
    });
    CHECK(at(field_of(plane), kMiddle, kMiddle, kMiddle) > 3.4F);
  }
}

TEST_CASE("sizes go with the root of the radius and of the tolerance", "[size_field]") {
  const auto on_surface = [](float radius, double tolerance) {
    plc::SizeSpec spec;
    spec.tolerance = tolerance;
    spec.finest = 0.1;
    return at(field_of(ball(radius), spec), kMiddle + radius, kMiddle, kMiddle);
  };
  const float small = on_surface(5, 0.05), large = on_surface(15, 0.05);
  CHECK(large / small == Approx(std::sqrt(3.0)).epsilon(0.15));
  CHECK(on_surface(10, 0.0125) / on_surface(10, 0.05) == Approx(0.5).epsilon(0.1));
  // e^2 kappa / 16 = tolerance, both curvatures together; edges of 1.5 sizes; delta is 1.25 voxels.
  const double radius = 10 * 0.8, edge = std::sqrt(0.05 * 16 * radius / std::sqrt(2.0));
  CHECK(static_cast<double>(on_surface(10, 0.05)) == Approx(edge / 1.5).epsilon(0.25));
}

TEST_CASE("noise is told from shape, also where values are clipped", "[size_field]") {
  const Image clean = ball(16);
  const plc::SizeField of_clean = field_of(clean);
  CHECK(of_clean.noise() < 0.005F);
  for (const float deviation : {0.01F, 0.04F, 0.1F}) {
    Image noisy = clean;
    samples::Random random(3);
    for (float& value : noisy.values) {
      // About normal: the sum of twelve.
      double sum = -6;
      for (int k = 0; k < 12; ++k) sum += random.uniform(0, 1);
      value += deviation * static_cast<float>(sum);
    }
    plc::ImageView view = noisy.view();
    view.form = {plc::ImageType::kF32, 0, 0, 0, 1, 4};
    plc::SizeField field;
    REQUIRE(field.build(view, 0.5F, 1, {}, samples::kSerial).ok());
    // Values rise by 0.25 a delta.
    CHECK(field.noise() == Approx(deviation / 0.25F).epsilon(0.15));
    // Of so small an image no place is passed over.
    CHECK(plc::surface_noise(view, 0.5F, 1, samples::kSerial) == field.noise());
    const float clean_size = at(of_clean, kMiddle + 16, kMiddle, kMiddle);
    CHECK(at(field, kMiddle + 16, kMiddle, kMiddle) == Approx(clean_size).epsilon(0.25));
  }
}

TEST_CASE("of a large image noise is told from some of its places, the same by any executor",
          "[size_field]") {
  constexpr int kLong = 160;
  std::vector<float> values;
  samples::Random random(5);
  for (int z = 0; z < kLong; ++z) {
    for (int i = 0; i < kLong * kLong; ++i) {
      const double ramp = 0.5 + 0.1 * (z - 0.5 * kLong + 0.1 * (i % kLong));
      values.push_back(static_cast<float>(ramp + random.uniform(-0.4, 0.4)));
    }
  }
  const plc::ImageView view{values.data(),
                            {kLong, kLong, kLong},
                            {1.25F, 1.25F, 1.25F},
                            {0, 0, 0},
                            {plc::ImageType::kF32, 0, 0, 0, 1, 4}};
  const float noise = plc::surface_noise(view, 0.5F, 1, samples::kSerial);
  // Values rise by 0.1 sqrt 1.01 a voxel, which is 0.8 delta.
  CHECK(noise == Approx(0.8 / std::sqrt(12) / 0.1 / 1.25 / std::sqrt(1.01)).epsilon(0.1));
  const plc::Schedule threads(3);
  CHECK(plc::surface_noise(view, 0.5F, 1, threads) == noise);
  CHECK(plc::surface_noise(view, 90, 1, samples::kSerial) == 0);
}

TEST_CASE("rods get the finest size, plates as thin do not", "[size_field]") {
  const Image rod =
      image_of([](float x, float y, float) { return 1.2F - std::hypot(x - kMiddle, y - kMiddle); });
  const Image plate = image_of([](float x, float, float) { return 1.2F - std::abs(x - kMiddle); });
  CHECK(at(field_of(rod), kMiddle + 1.2F, kMiddle, kMiddle) < 0.9F);
  CHECK(at(field_of(plate), kMiddle + 1.2F, kMiddle, kMiddle) > 2);
}

TEST_CASE("sizes grow no faster than their slope, and are the same for any executor",
          "[size_field]") {
  plc::SizeSpec spec;
  spec.slope = 0.2;
  const Image image = ball(4);
  const plc::SizeField field = field_of(image, spec),
                       again = field_of(image, spec, plc::Schedule(4));
  CHECK(field.slope() == 0.2F);
  CHECK(field.finest() == 0.5F);
  float most = 0;
  for (float z = 0; z < kSide; z += 2.1F) {
    for (float y = 0; y < kSide; y += 2.3F) {
      for (float x = 0; x < kSide - 1; x += 1.7F) {
        REQUIRE(at(field, x, y, z) == at(again, x, y, z));
        most = std::max(most, std::abs(at(field, x + 1, y, z) - at(field, x, y, z)) / 0.8F);
      }
    }
  }
  CHECK(most > 0.15F);
  CHECK(most < 0.21F);
}

TEST_CASE("sizes are lowered where voxels are, in whatever order, and grow from there by the slope",
          "[size_field]") {
  const Image plane = image_of([](float x, float, float) { return x - kMiddle; });
  const std::array<int32_t, 3> here{24, 12, 12}, there{24, 20, 4};  // in cubes of two voxels
  plc::SizeField both = field_of(plane), twice = both;
  const plc::SizeField before = both;
  both.lower(here, 1, 0);
  both.lower(there, 0.75F, 0);
  both.bound_slope();
  twice.lower(there, 0.75F, 0);
  twice.bound_slope();
  twice.lower(here, 1, 0);
  twice.lower(there, 0.75F, 0);
  twice.bound_slope();
  float most = 0;
  for (float z = 0; z < kSide; z += 1.9F) {
    for (float y = 0; y < kSide - 1; y += 2.1F) {
      for (float x = 0; x < kSide; x += 2.3F) {
        REQUIRE(at(both, x, y, z) == at(twice, x, y, z));
        CHECK(at(both, x, y, z) <= at(before, x, y, z));
        most = std::max(most, std::abs(at(both, x, y + 1, z) - at(both, x, y, z)) / 0.8F);
      }
    }
  }
  CHECK(at(both, 24.5F, 12.5F, 12.5F) == 1);
  CHECK(at(both, 24.5F, 20.5F, 4.5F) == 0.75F);
  CHECK(at(before, 24, 12, 12) > 3.4F);
  both.lower(there, 0.25F, 1);
  both.bound_slope();
  CHECK(at(both, 24, 20, 4) == both.finest());  // between two cubes
  CHECK(at(both, 24, 46, 46) == at(before, 24, 46, 46));
  CHECK(most > 0.08F);
  CHECK(most < 0.12F);
}

TEST_CASE("sizes grow from where they were lowered by chamfer steps, at the border, too",
          "[size_field]") {
  const Image empty = image_of([](float, float, float) { return -100.0F; });
  constexpr int kCells = kSide / 2;
  for (const std::array<int32_t, 3>& cell :
       {std::array<int32_t, 3>{0, 0, 0}, {23, 0, 0}, {0, 23, 1}, {23, 22, 23}, {11, 5, 17}}) {
    plc::SizeField field = field_of(empty);
    field.lower({2 * cell[0], 2 * cell[1], 2 * cell[2]}, 1, 0);
    field.bound_slope();
    bool right = true;
    for (int z = 0; z < kCells; ++z) {
      for (int y = 0; y < kCells; ++y) {
        for (int x = 0; x < kCells; ++x) {
          std::array<int, 3> away{std::abs(x - cell[0]), std::abs(y - cell[1]),
                                  std::abs(z - cell[2])};
          std::sort(away.begin(), away.end());
          // Cubes are 1.6 wide; slope 0.1, in steps of 1/32, of which 5, 7 and 8 are whole.
          const int steps = 8 * away[0] + 7 * (away[1] - away[0]) + 5 * (away[2] - away[1]);
          const float expected = std::min(4.0F, 1 + static_cast<float>(steps) / 32);
          right = right && at(field, 2.0F * static_cast<float>(x) + 0.5F,
                              2.0F * static_cast<float>(y) + 0.5F,
                              2.0F * static_cast<float>(z) + 0.5F) == Approx(expected);
        }
      }
    }
    CAPTURE(cell);
    CHECK(right);
  }
}

TEST_CASE("beyond the image sizes are those of its border", "[size_field]") {
  const plc::SizeField field = field_of(ball(10));
  CHECK(at(field, -50, kMiddle, kMiddle) == at(field, 0, kMiddle, kMiddle));
  CHECK(at(field, 1e9F, NAN, kMiddle) >= plc::SizeField::kStep);
  CHECK(field.above_delta(NAN, NAN, NAN) >= plc::SizeField::kLeast);
}
