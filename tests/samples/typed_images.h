// Images in every voxel type, and the same as floats.
#pragma once
#include <random>
#include <type_traits>
#include <vector>

#include "kernels/image.h"
#include "kernels/image_value.h"
#include "tests/samples/sample_levels.h"

namespace fixtures {

template <typename Voxel>
constexpr plc::ImageType image_type() {
  if constexpr (std::is_same_v<Voxel, uint8_t>) return plc::ImageType::kU8;
  if constexpr (std::is_same_v<Voxel, int16_t>) return plc::ImageType::kI16;
  if constexpr (std::is_same_v<Voxel, uint16_t>) return plc::ImageType::kU16;
  if constexpr (std::is_same_v<Voxel, float>) return plc::ImageType::kF32;
  return plc::ImageType::kUnit;
}

// Random voxels of all of the type's range (floats: -20 .. 20, some of them NaN), a window that
// clips some of them, `beyond` farther out, and a padding. The voxels fill their allocation: a
// sanitizer sees what is read beside them.
template <typename Voxel>
struct TypedImage {
  std::vector<Voxel> voxels;
  plc::ImageView view;

  TypedImage(int32_t m, int32_t n, int32_t p, int32_t pad, uint32_t seed, float beyond = 0)
      : voxels(static_cast<size_t>(m) * static_cast<size_t>(n) * static_cast<size_t>(p)) {
    std::mt19937 random(seed);
    for (Voxel& v : voxels) {
      if constexpr (std::is_integral_v<Voxel>) {
        v = static_cast<Voxel>(random());
      } else {
        v = static_cast<float>(random() >> 8) / 16777216.0F * 40 - 20;
        if (random() % 97 == 0) v = std::nanf("");
      }
    }
    view.data = voxels.data();
    view.dims[0] = m + 2 * pad;
    view.dims[1] = n + 2 * pad;
    view.dims[2] = p + 2 * pad;
    const float low = std::is_same_v<Voxel, float>     ? -13.1F
                      : std::is_same_v<Voxel, int16_t> ? -20000.3F
                                                       : 30.7F;
    const float width = sizeof(Voxel) == 1 ? 180.1F : sizeof(Voxel) == 2 ? 33000.7F : 25.3F;
    view.form = {image_type<Voxel>(), pad, 0.375F, low, 1 / width, beyond};
  }

  // The whole image as floats, its padding included.
  std::vector<float> values() const { return samples::values_of(view); }
  // `values` in the place of this image.
  plc::ImageView unit_view(const std::vector<float>& values) const {
    plc::ImageView unit = view;
    unit.data = values.data();
    unit.form = {};
    return unit;
  }
};

}  // namespace fixtures
