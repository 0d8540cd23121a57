// The kernels over images, each run once on random input: hashes of all that it writes.
#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "kernels/blend_rows.h"
#include "kernels/gradient_force.h"
#include "kernels/image_force.h"
#include "kernels/image_rows.h"
#include "kernels/separable.h"
#include "kernels/sobel.h"
#include "kernels/voxels.h"
#include "kernels/weighted_rows.h"
#include "pyramid/buffer.h"
#include "tests/kernels/golden_hash.h"
#include "tests/samples/typed_images.h"

namespace golden {

// ---- image_force.h, image_rows.h, gradient_force.h: places in and around an image.

inline std::vector<Float4> places() {
  const std::vector<float> v = random_floats(size_t{3} * 512, -4, 40, 41);
  std::vector<Float4> all;
  for (size_t i = 0; i + 2 < v.size(); i += 3) all.push_back({v[i], v[i + 1], v[i + 2], 0});
  return all;
}

template <typename Voxel>
struct Image {
  TypedImage<Voxel> image{33, 29, 27, 2, 42};
  plc::ImageView view = image.view;
  Image() {
    for (int a = 0; a < 3; ++a) {
      view.scale[a] = 0.9F;
      view.offset[a] = 1.3F;
    }
  }
};

// Values in [0,1] as they are: a pyramid's own levels.
template <>
struct Image<plc::UnitVoxel> {
  std::vector<float> values = random_floats(size_t{33} * 29 * 27, 0, 1, 42);
  plc::ImageView view{values.data(), {33, 29, 27}, {0.9F, 0.9F, 0.9F}, {1.3F, 1.3F, 1.3F}};
};

template <typename Voxel>
inline uint64_t sample_trilinear(SimdTarget simd) {
  const Image<Voxel> image;
  const std::vector<Float4> at = places();
  std::vector<float> values(at.size());
  const auto end = static_cast<uint32_t>(at.size() - 5);
  kernels::sample_trilinear(simd, image.view, at.data(), 3, end, values.data());
  return hash_of(values);
}

template <typename Voxel>
inline uint64_t iso_force(SimdTarget simd) {
  const Image<Voxel> image;
  const std::vector<Float4> at = places();
  const auto n = static_cast<uint32_t>(at.size());
  const Three normal(n, -1, 1, 43);
  Three force(n, -1, 1, 46);
  kernels::iso_force(simd, image.view, at.data(), normal.in(), {-1.2F, 0.4F}, 0, n, force.out());
  return hash_of(force);
}

template <typename Voxel>
inline uint64_t image_rows(SimdTarget simd) {
  const Image<Voxel> image;
  std::vector<float> values(size_t{8} * static_cast<size_t>(image.view.dims[0]));
  kernels::image_rows(simd, image.view, 12, 0, 8, values.data());
  return hash_of(values);
}

inline uint64_t gradient_force(SimdTarget simd) {
  std::vector<Float4> vectors;
  const Three field(size_t{21} * 19 * 17, -1, 1, 51);
  for (size_t i = 0; i < field.x.size(); ++i) {
    vectors.push_back({field.x[i], field.y[i], field.z[i], 0});
  }
  const plc::GradientView view{vectors.data(), {21, 19, 17}, {0.5F, 0.6F, 0.7F}, {1, 2, 3}};
  const std::vector<Float4> at = places();
  const auto n = static_cast<uint32_t>(at.size());
  const Three normal(n, -1, 1, 54);
  Three force(n, -1, 1, 57);
  kernels::gradient_force(simd, view, at.data(), normal.in(), {1.3F, -0.4F, {1, 0.5F, 3}}, 0, n,
                          force.out());
  return hash_of(force);
}

// ---- Rows: sobel.h, separable.h, weighted_rows.h, blend_rows.h. Widths that fill no vector.

inline constexpr size_t kWidth = 93;

template <size_t kCount>
struct Rows {
  std::vector<float> values = random_floats(kCount * kWidth, 0, 1, 61);
  std::array<const float*, kCount> row{};
  Rows() {
    for (size_t i = 0; i < kCount; ++i) row[i] = values.data() + i * kWidth;
  }
};

inline uint64_t sobel(SimdTarget simd) {
  const Rows<9> rows;
  Three gradient(kWidth);
  std::vector<float> scratch(kernels::sobel_scratch(kWidth));
  const auto [gx, gy, gz] = gradient.out();
  kernels::sobel(simd, rows.row.data(), kWidth, {1, 0.7F, 1.9F}, scratch.data(), gx, gy, gz);
  return hash_of(gradient);
}

inline uint64_t bound_vectors(SimdTarget simd) {
  const Three g(kWidth, -1, 1, 64);
  std::vector<Float4> vectors(kWidth);
  kernels::bound_vectors(simd, g.x.data(), g.y.data(), g.z.data(), kWidth, 0.8F, vectors.data());
  return hash_of(flatten(vectors));
}

inline uint64_t vector_norms(SimdTarget simd) {
  const Three g(kWidth, -1, 1, 64);
  std::vector<float> norms(kWidth);
  kernels::vector_norms(simd, g.x.data(), g.y.data(), g.z.data(), kWidth, 0.3F, norms.data());
  return hash_of(norms);
}

inline uint64_t reduce_x(SimdTarget simd) {
  const Rows<21> rows;
  const Taps taps(kWidth, 53, 5, 67);
  std::vector<float> out(size_t{21} * 53);
  plc::Buffer<float> scratch(kernels::reduce_x_scratch(kWidth));
  kernels::reduce_x(simd, taps.view, {rows.row[0], kWidth, kWidth}, 21, {out.data(), 53, 53},
                    scratch.data());
  return hash_of(out);
}

inline uint64_t reduce_y(SimdTarget simd) {
  const Rows<21> rows;
  const Taps taps(21, 12, 4, 68);
  std::vector<float> out(size_t{12} * kWidth);
  kernels::reduce_y(simd, taps.view, 0, 12, {rows.row[0], kWidth, kWidth},
                    {out.data(), kWidth, kWidth});
  return hash_of(out);
}

inline uint64_t reduce_z(SimdTarget simd) {
  const Rows<5> planes;
  const std::vector<float> weights = random_floats(5, 0, 0.5F, 69);
  std::vector<float> out(kWidth);
  kernels::reduce_z(simd, weights.data(), 5, planes.row.data(), kWidth, out.data());
  return hash_of(out);
}

inline uint64_t weighted_rows(SimdTarget simd) {
  const Rows<7> rows;
  const std::vector<float> weights = random_floats(7, -1, 1, 70);
  std::vector<float> out(kWidth);
  kernels::weighted_rows(simd, weights.data(), 7, rows.row.data(), 2, kWidth - 3, out.data());
  return hash_of(out);
}

inline uint64_t blend_rows(SimdTarget simd) {
  const Rows<4> rows;
  std::vector<float> out(kWidth);
  kernels::blend_rows(simd, rows.row, 0.3F, 0.85F, 2, kWidth - 3, out.data());
  return hash_of(out);
}

// ---- voxels.h

template <typename Voxel>
std::vector<Voxel> voxels() {
  std::mt19937 random(81);
  std::vector<Voxel> all(1013);
  for (Voxel& v : all) {
    if constexpr (std::is_integral_v<Voxel>) {
      v = static_cast<Voxel>(random());
    } else {
      v = random_float(random, -50, 900);
      if (random() % 37 == 0) v = std::nanf("");
      if (random() % 41 == 0) v = -std::numeric_limits<float>::infinity();
    }
  }
  return all;
}

template <plc::VoxelType kType, typename Voxel>
uint64_t normalize_voxels(SimdTarget simd) {
  const std::vector<Voxel> in = voxels<Voxel>();
  std::vector<float> out(in.size());
  // Some of every type are clipped on either side.
  const double low = sizeof(Voxel) == 1 ? 20.3 : -17.7;
  const double width = std::is_same_v<Voxel, int32_t> ? 1.7e9 : sizeof(Voxel) == 1 ? 200 : 700;
  kernels::normalize_voxels(simd, kType, in.data(), in.size(), low, 1 / width, out.data());
  return hash_of(out);
}

template <plc::VoxelType kType, typename Voxel>
uint64_t voxel_extent(SimdTarget simd) {
  const std::vector<Voxel> in = voxels<Voxel>();
  const kernels::VoxelExtent extent = kernels::voxel_extent(simd, kType, in.data(), in.size());
  Fnv hash;
  hash.add(extent.low);
  hash.add(extent.high);
  hash.add(uint64_t{extent.not_finite});
  return hash.value();
}

}  // namespace golden
