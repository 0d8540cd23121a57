#include "tools/volume/volume_statistics.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

namespace {

using plc::tools::otsu_of;
using plc::tools::percentiles_of;
using plc::tools::range_of;

template <typename T>
plc_image image_of(plc_voxel_type type, const std::vector<T>& voxels) {
  plc_image image;
  plc_image_defaults(&image);
  image.type = type;
  image.voxels = voxels.data();
  image.dims[0] = static_cast<int64_t>(voxels.size()) / 4;
  image.dims[1] = image.dims[2] = 2;
  return image;
}

// Many different values of both signs, where the type has them.
template <typename T>
std::vector<T> scattered(double low, double high) {
  std::vector<T> voxels;
  uint64_t random = 7;
  for (int i = 0; i < 4000; ++i) {
    random = random * 6364136223846793005U + 1442695040888963407U;
    const double part = static_cast<double>(random >> 40) / 16777216.0;
    voxels.push_back(static_cast<T>(low + part * part * (high - low)));
  }
  return voxels;
}

template <typename T>
void check_percentiles(plc_voxel_type type, double low, double high) {
  CAPTURE(type);
  const std::vector<T> voxels = scattered<T>(low, high);
  std::vector<T> sorted = voxels;
  std::sort(sorted.begin(), sorted.end());
  const plc_image image = image_of(type, voxels);
  const std::vector<double> percents = {0, 0.01, 1, 12.5, 50, 50.01, 95, 100};
  const std::vector<double> found = percentiles_of(image, percents);
  for (size_t i = 0; i < percents.size(); ++i) {
    const double rank = std::ceil(percents[i] / 100 * 4000) - 1;
    CHECK(found[i] == static_cast<double>(sorted[static_cast<size_t>(std::max(rank, 0.0))]));
  }
  CHECK(range_of(image).low == static_cast<double>(sorted.front()));
  CHECK(range_of(image).high == static_cast<double>(sorted.back()));
  CHECK(range_of(image).finite == 4000);
}

}  // namespace

TEST_CASE("Percentiles are values of the image, in every type of voxel", "[volume_statistics]") {
  check_percentiles<uint8_t>(PLC_U8, 0, 255);
  check_percentiles<int16_t>(PLC_I16, -32768, 32767);
  check_percentiles<uint16_t>(PLC_U16, 0, 65535);
  check_percentiles<int32_t>(PLC_I32, -2e9, 2e9);
  check_percentiles<float>(PLC_F32, -1e-3, 1e6);
}

TEST_CASE("Otsu's threshold lies between two classes, in the middle of what is between them",
          "[volume_statistics]") {
  std::vector<uint8_t> two(400, 0);
  std::fill(two.begin() + 100, two.end(), uint8_t{255});
  CHECK(otsu_of(image_of(PLC_U8, two)) == 127.5);
  std::vector<int16_t> hounsfield(400, -1000);
  std::fill(hounsfield.begin() + 300, hounsfield.end(), int16_t{401});
  CHECK(otsu_of(image_of(PLC_I16, hounsfield)) == Approx(-299.5));
  std::vector<float> floats(400, 0.25F);
  std::fill(floats.begin() + 50, floats.end(), 0.75F);
  CHECK(otsu_of(image_of(PLC_F32, floats)) == Approx(0.5).margin(1e-4));
  std::vector<int32_t> wide(400, -1000000);
  std::fill(wide.begin() + 50, wide.end(), 3000000);
  CHECK(otsu_of(image_of(PLC_I32, wide)) == Approx(1000000).margin(100));
}

// By the definition, over all thresholds.
TEST_CASE("Otsu's threshold is the best one", "[volume_statistics]") {
  std::vector<uint8_t> voxels = scattered<uint8_t>(0, 90);
  for (size_t i = 0; i < voxels.size(); i += 3) voxels[i] = static_cast<uint8_t>(voxels[i] + 120);
  double best = -1;
  double at = 0;
  for (int t = 0; t < 255; ++t) {
    double n[2] = {0, 0};
    double sum[2] = {0, 0};
    for (const uint8_t v : voxels) {
      n[v > t ? 1 : 0] += 1;
      sum[v > t ? 1 : 0] += v;
    }
    if (n[0] == 0 || n[1] == 0) continue;
    const double apart = sum[0] / n[0] - sum[1] / n[1];
    if (n[0] * n[1] * apart * apart > best) {
      best = n[0] * n[1] * apart * apart;
      at = t;
    }
  }
  CHECK(std::abs(otsu_of(image_of(PLC_U8, voxels)) - (at + 0.5)) <= 15);
  CHECK(otsu_of(image_of(PLC_U8, voxels)) >= at + 0.5);
}

TEST_CASE("What is not finite is counted and left out", "[volume_statistics]") {
  std::vector<float> voxels(40, 1);
  voxels[3] = std::numeric_limits<float>::quiet_NaN();
  voxels[4] = std::numeric_limits<float>::infinity();
  voxels[5] = -2;
  const plc_image image = image_of(PLC_F32, voxels);
  CHECK(range_of(image).not_finite == 2);
  CHECK(range_of(image).low == -2);
  CHECK(percentiles_of(image, {0, 100}) == std::vector<double>{-2, 1});
  CHECK(otsu_of(image) == Approx(-0.5).margin(1e-3));
  const std::vector<float> none(40, std::numeric_limits<float>::quiet_NaN());
  CHECK(std::isnan(range_of(image_of(PLC_F32, none)).low));
  CHECK(std::isnan(percentiles_of(image_of(PLC_F32, none), {50})[0]));
  CHECK(std::isnan(otsu_of(image_of(PLC_F32, none))));
  CHECK(std::isnan(otsu_of(image_of(PLC_U8, std::vector<uint8_t>(40, 7)))));
}
