#include "kernels/image_force.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "kernels/scalar.h"
#include "tests/samples/kernel_fixtures.h"
#include "tests/samples/typed_images.h"

namespace {

using namespace fixtures;
using plc::Float4;
using plc::ImageView;
using plc::SimdTarget;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

struct Image {
  std::vector<float> values;
  ImageView view;
  Image(int32_t m, int32_t n, int32_t p, uint32_t seed)
      : values(
            random_floats(static_cast<size_t>(m) * static_cast<size_t>(n) * static_cast<size_t>(p),
                          0.0F, 1.0F, seed)) {
    view.data = values.data();
    view.dims[0] = m;
    view.dims[1] = n;
    view.dims[2] = p;
  }
};

// Eight voxels weighted by the opposite volumes, in double; outside, the border is replicated.
double expected_sample(const ImageView& image, const Float4& p) {
  const double place[3] = {double{p.x}, double{p.y}, double{p.z}};
  int32_t cell[3];
  double fraction[3];
  for (int a = 0; a < 3; ++a) {
    const double c = std::clamp(double{image.scale[a]} * place[a] + double{image.offset[a]}, 0.0,
                                static_cast<double>(image.dims[a] - 1));
    cell[a] = std::min(static_cast<int32_t>(c), image.dims[a] - 2);
    fraction[a] = c - cell[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int32_t index[3];
    for (int a = 0; a < 3; ++a) {
      const int32_t up = corner >> a & 1;
      weight *= up == 1 ? fraction[a] : 1.0 - fraction[a];
      index[a] = cell[a] + up;
    }
    const int32_t at = index[0] + image.dims[0] * (index[1] + image.dims[1] * index[2]);
    sum += weight * double{static_cast<const float*>(image.data)[at]};
  }
  return sum;
}

// Inside, on voxels, on the border and far outside of an image of mesh extent about 40.
std::vector<Float4> places(uint32_t count, uint32_t seed) {
  const std::vector<float> v = random_floats(size_t{count} * 3, -10.0F, 50.0F, seed);
  std::vector<Float4> all(count);
  for (uint32_t i = 0; i < count; ++i) {
    all[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2], 0.0F};
    if (i % 5 == 1) all[i] = {std::floor(all[i].x), std::floor(all[i].y), all[i].z, 0.0F};
  }
  return all;
}

}  // namespace

TEST_CASE("sampling is trilinear between voxel centres", "[kernels]") {
  Image image(37, 23, 11, 1);
  image.view.scale[0] = 0.9F;
  image.view.scale[2] = 0.25F;
  image.view.offset[0] = 0.5F;
  image.view.offset[1] = -3.25F;
  const std::vector<Float4> position = places(163, 2);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const uint32_t begin : {0U, 1U, 7U, 160U}) {
      for (const uint32_t end : {163U, 162U, 161U, 160U}) {
        CAPTURE(plc::simd_target_name(simd), begin, end);
        std::vector<float> got(position.size(), kUntouched);
        std::vector<float> twin = got;
        kernels::sample_trilinear(simd, image.view, position.data(), begin, end, got.data());
        scalar::sample_trilinear(image.view, position.data(), begin, end, twin.data());
        REQUIRE(first_difference(got, twin) == -1);
        for (uint32_t i = 0; i < got.size(); ++i) {
          CAPTURE(i);
          if (i < begin || i >= end) {
            REQUIRE(got[i] == kUntouched);
          } else {
            REQUIRE(double{got[i]} ==
                    Approx(expected_sample(image.view, position[i])).margin(1e-5));
          }
        }
      }
    }
  }
}

TEST_CASE("between voxels that the window clips samples are those of the voxels as they are",
          "[kernels]") {
  // -1 and 3, of which iso 0.5 is 3/8 away from the first; clipped it would be in the middle.
  const std::vector<int16_t> voxels = {0, 400, 0, 400, 0, 400, 0, 400};
  ImageView image;
  image.data = voxels.data();
  for (int32_t& dim : image.dims) dim = 2;
  image.form = {plc::ImageType::kI16, 0, 0, 100, 0.01F, 4};
  const std::vector<Float4> position(8, {0.375F, 0.3F, 0.6F, 0});
  const std::vector<Float4> far(8, {0.1F, 0.3F, 0.6F, 0});
  for (const SimdTarget simd : plc::available_simd_targets()) {
    std::vector<float> near_iso(8), below(8);
    kernels::sample_trilinear(simd, image, position.data(), 0, 8, near_iso.data());
    kernels::sample_trilinear(simd, image, far.data(), 0, 8, below.data());
    for (const float value : near_iso) REQUIRE(value == Approx(0.5F));
    for (const float value : below) REQUIRE(value == 0);
  }
}

TEST_CASE("a sample on a voxel is that voxel", "[kernels]") {
  const Image image(5, 4, 3, 3);
  std::vector<Float4> position;
  for (int z = 0; z < 3; ++z) {
    for (int y = 0; y < 4; ++y) {
      for (int x = 0; x < 5; ++x) {
        position.push_back(
            {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0.0F});
      }
    }
  }
  for (const SimdTarget simd : plc::available_simd_targets()) {
    std::vector<float> got(position.size());
    kernels::sample_trilinear(simd, image.view, position.data(), 0,
                              static_cast<uint32_t>(got.size()), got.data());
    for (size_t i = 0; i < got.size(); ++i) REQUIRE(got[i] == Approx(image.values[i]).margin(1e-6));
  }
}

TEST_CASE("no position makes sampling read outside the image", "[kernels]") {
  // The image fills its allocation, so that a sanitizer sees any voxel read outside of it.
  Image image(2, 2, 2, 4);
  std::vector<Float4> position;
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<float> wild = {std::numeric_limits<float>::quiet_NaN(),
                                   inf,
                                   -inf,
                                   3.4e38F,
                                   -3.4e38F,
                                   2147483648.0F,
                                   -2147483904.0F,
                                   0.5F};
  for (const float x : wild) {
    for (const float y : wild) {
      for (const float z : wild) position.push_back({x, y, z, 0.0F});
    }
  }
  for (const float scale : {1.0F, 1e30F, -1.0F, 0.0F}) {
    for (float& s : image.view.scale) s = scale;
    for (const SimdTarget simd : plc::available_simd_targets()) {
      std::vector<float> got(position.size());
      std::vector<float> twin(position.size());
      const auto count = static_cast<uint32_t>(got.size());
      kernels::sample_trilinear(simd, image.view, position.data(), 0, count, got.data());
      scalar::sample_trilinear(image.view, position.data(), 0, count, twin.data());
      REQUIRE(first_difference(got, twin) == -1);
      for (const float value : got) REQUIRE((value >= 0.0F && value <= 1.0F));
    }
  }
}

TEST_CASE("the iso-potential force is equation (7), added to what is there", "[kernels]") {
  const Image image(37, 23, 11, 5);
  const uint32_t count = 160;
  const std::vector<Float4> position = places(count, 6);
  const std::vector<float> nx = random_floats(count, -1, 1, 7);
  const std::vector<float> ny = random_floats(count, -1, 1, 8);
  const std::vector<float> nz = random_floats(count, -1, 1, 9);
  const kernels::ConstFloat3s n{nx.data(), ny.data(), nz.data()};
  const float coefficient = -1.7F, iso = 0.3F;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (const uint32_t begin : {0U, 16U, 144U}) {
      const uint32_t end = begin == 16 ? 96 : count;
      CAPTURE(plc::simd_target_name(simd), begin, end);
      std::vector<float> got[3], twin[3];
      for (uint32_t a = 0; a < 3; ++a) got[a] = twin[a] = random_floats(count, -5, 5, 10 + a);
      const std::vector<float> before[3] = {got[0], got[1], got[2]};
      kernels::iso_force(simd, image.view, position.data(), n, {coefficient, iso}, begin, end,
                         {got[0].data(), got[1].data(), got[2].data()});
      scalar::iso_force(image.view, position.data(), n, {coefficient, iso}, begin, end,
                        {twin[0].data(), twin[1].data(), twin[2].data()});
      const float* normal[3] = {nx.data(), ny.data(), nz.data()};
      for (int a = 0; a < 3; ++a) {
        REQUIRE(first_difference(got[a], twin[a]) == -1);
        for (uint32_t i = 0; i < count; ++i) {
          const bool in_range = i >= begin && i < end;
          const double push = in_range
                                  ? double{coefficient} *
                                        (double{iso} - expected_sample(image.view, position[i])) *
                                        double{normal[a][i]}
                                  : 0.0;
          CAPTURE(i, a);
          REQUIRE(double{got[a][i]} == Approx(double{before[a][i]} + push).margin(2e-5));
          if (!in_range) REQUIRE(got[a][i] == before[a][i]);
        }
      }
    }
  }
}

TEMPLATE_TEST_CASE("a typed image is sampled and pulls as the same image in floats, bit for bit",
                   "[kernels]", uint8_t, int16_t, uint16_t, float) {
  const int32_t sizes[][3] = {{37, 23, 11}, {2, 2, 2}, {2, 19, 3}};
  for (const auto& [m, n, p] : sizes) {
    for (const int32_t pad : {0, 1, 6}) {
      TypedImage<TestType> image(m, n, p, pad, 11, 0.2F);
      image.view.scale[0] = 0.9F;
      image.view.offset[1] = -3.25F;
      const std::vector<float> values = image.values();
      const ImageView unit = image.unit_view(values);
      const uint32_t count = 320;
      // The last are all inside, so that whole vectors are.
      std::vector<Float4> position = places(count, 12);
      for (uint32_t i = count / 2; i < count; ++i) {
        const auto within = [](float c, int32_t size, float from) {
          return from + std::fmod(std::abs(c), static_cast<float>(size - 1));
        };
        const float border = static_cast<float>(pad);
        position[i].x = within(position[i].x, m, border) / 0.9F;
        position[i].y = within(position[i].y, n, border) + 3.25F;
        position[i].z = within(position[i].z, p, border);
      }
      const std::vector<float> normal = random_floats(count, -1, 1, 13);
      for (const SimdTarget simd : plc::available_simd_targets()) {
        CAPTURE(plc::simd_target_name(simd), m, n, p, pad);
        std::vector<float> got(count), expected(count), twin(count);
        kernels::sample_trilinear(simd, image.view, position.data(), 0, count - 3, got.data());
        kernels::sample_trilinear(simd, unit, position.data(), 0, count - 3, expected.data());
        scalar::sample_trilinear(image.view, position.data(), 0, count - 3, twin.data());
        REQUIRE(first_difference(got, expected) == -1);
        REQUIRE(first_difference(got, twin) == -1);
        std::vector<float> pull(3 * count), unit_pull(3 * count);
        const auto force = [&](const ImageView& view, std::vector<float>& f) {
          kernels::iso_force(simd, view, position.data(),
                             {normal.data(), normal.data(), normal.data()}, {1.5F, 0.4F}, 0, count,
                             {f.data(), f.data() + count, f.data() + 2 * count});
        };
        force(image.view, pull);
        force(unit, unit_pull);
        REQUIRE(first_difference(pull, unit_pull) == -1);
      }
    }
  }
}

TEST_CASE("no position makes sampling read beside typed voxels", "[kernels]") {
  const float inf = std::numeric_limits<float>::infinity();
  const std::vector<float> wild = {std::nanf(""), inf,   -inf, 3.4e38F, -3.4e38F, 2147483648.0F,
                                   -1.0F,         0.99F, 2.5F, 6.5F,    7.0F,     7.5F};
  std::vector<Float4> position;
  for (const float x : wild) {
    for (const float y : wild) {
      for (const float z : wild) position.push_back({x, y, z, 0.0F});
    }
  }
  const auto count = static_cast<uint32_t>(position.size());
  const auto check = [&](const auto& image) {
    const std::vector<float> values = image.values();
    for (const SimdTarget simd : plc::available_simd_targets()) {
      std::vector<float> got(count), expected(count);
      kernels::sample_trilinear(simd, image.view, position.data(), 0, count, got.data());
      kernels::sample_trilinear(simd, image.unit_view(values), position.data(), 0, count,
                                expected.data());
      REQUIRE(first_difference(got, expected) == -1);
    }
  };
  for (const int32_t pad : {0, 6}) {
    check(TypedImage<uint8_t>(2, 2, 2, pad, 1));
    check(TypedImage<int16_t>(2, 2, 2, pad, 2));
    check(TypedImage<uint16_t>(2, 2, 2, pad, 3));
    check(TypedImage<float>(2, 2, 2, pad, 4));
  }
}
