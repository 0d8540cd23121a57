#include "kernels/gradient_force.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "kernels/scalar.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::Float4;
using plc::GradientView;
using plc::SimdTarget;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;
using Vector = std::array<double, 3>;

struct Field {
  std::vector<Float4> vectors;
  GradientView view;
  Field(int32_t m, int32_t n, int32_t p, uint32_t seed)
      : vectors(static_cast<size_t>(m) * static_cast<size_t>(n) * static_cast<size_t>(p)) {
    const std::vector<float> v = random_floats(3 * vectors.size(), -1, 1, seed);
    for (size_t i = 0; i < vectors.size(); ++i) {
      vectors[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2], 0.0F};
    }
    view.data = vectors.data();
    view.dims[0] = m;
    view.dims[1] = n;
    view.dims[2] = p;
  }
};

// Eight vectors weighted by the opposite volumes, in double; outside, the border is replicated.
Vector expected_gradient(const GradientView& field, const Float4& p) {
  const double place[3] = {double{p.x}, double{p.y}, double{p.z}};
  int32_t cell[3];
  double fraction[3];
  for (int a = 0; a < 3; ++a) {
    const double c = std::clamp(double{field.scale[a]} * place[a] + double{field.offset[a]}, 0.0,
                                static_cast<double>(field.dims[a] - 1));
    cell[a] = std::min(static_cast<int32_t>(c), field.dims[a] - 2);
    fraction[a] = c - cell[a];
  }
  Vector sum{};
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    int32_t index[3];
    for (int a = 0; a < 3; ++a) {
      const int32_t up = corner >> a & 1;
      weight *= up == 1 ? fraction[a] : 1.0 - fraction[a];
      index[a] = cell[a] + up;
    }
    const Float4& v = field.data[index[0] + field.dims[0] * (index[1] + field.dims[1] * index[2])];
    sum[0] += weight * double{v.x};
    sum[1] += weight * double{v.y};
    sum[2] += weight * double{v.z};
  }
  return sum;
}

struct Streams {
  std::vector<float> axis[3];
  Streams(uint32_t count, float low, float high, uint32_t seed) {
    for (uint32_t a = 0; a < 3; ++a) axis[a] = random_floats(count, low, high, seed + a);
  }
  kernels::ConstFloat3s in() const { return {axis[0].data(), axis[1].data(), axis[2].data()}; }
  kernels::Float3s out() { return {axis[0].data(), axis[1].data(), axis[2].data()}; }
};

Streams unit_normals(uint32_t count, uint32_t seed) {
  Streams n(count, -1, 1, seed);
  for (uint32_t i = 0; i < count; ++i) {
    const float length = std::hypot(n.axis[0][i], n.axis[1][i], n.axis[2][i]);
    for (std::vector<float>& a : n.axis) a[i] /= length;
  }
  return n;
}

std::vector<Float4> places(uint32_t count, uint32_t seed) {
  const std::vector<float> v = random_floats(size_t{count} * 3, -10.0F, 50.0F, seed);
  std::vector<Float4> all(count);
  for (uint32_t i = 0; i < count; ++i) all[i] = {v[3 * i], v[3 * i + 1], v[3 * i + 2], 0.0F};
  return all;
}

void apply(SimdTarget simd, const GradientView& view, const std::vector<Float4>& position,
           const Streams& n, const kernels::GradientPull& c, uint32_t begin, uint32_t end,
           Streams& f) {
  kernels::gradient_force(simd, view, position.data(), n.in(), c, begin, end, f.out());
}

void apply_twin(const GradientView& view, const std::vector<Float4>& position, const Streams& n,
                const kernels::GradientPull& c, uint32_t begin, uint32_t end, Streams& f) {
  scalar::gradient_force(view, position.data(), n.in(), c, begin, end, f.out());
}

// (8) as it is written, with delta in the coefficients: (alpha - beta) (g . n) n + beta g.
Vector equation_8(const Vector& g, const Vector& n, const kernels::GradientPull& c) {
  const double along = g[0] * n[0] + g[1] * n[1] + g[2] * n[2];
  const double alpha = double{c.along_normal}, beta = double{c.along_tangent};
  Vector f{};
  for (size_t a = 0; a < 3; ++a) {
    f[a] = double{c.map[a]} * ((alpha - beta) * along * n[a] + beta * g[a]);
  }
  return f;
}

}  // namespace

TEST_CASE("the gradient force is equation (8), added to what is there", "[kernels]") {
  Field field(37, 23, 11, 1);
  field.view.scale[0] = 0.9F;
  field.view.scale[2] = 0.25F;
  field.view.offset[0] = 0.5F;
  field.view.offset[1] = -3.25F;
  const uint32_t count = 160;
  const std::vector<Float4> position = places(count, 2);
  const Streams n = unit_normals(count, 3);
  for (const kernels::GradientPull& c :
       {kernels::GradientPull{1.3F, -0.4F, {1, 1, 1}}, kernels::GradientPull{0.6F, 0.6F, {1, 1, 1}},
        kernels::GradientPull{-0.7F, 0.2F, {0.5F, 2.0F, 3.0F}}}) {
    for (const SimdTarget simd : plc::available_simd_targets()) {
      for (const uint32_t begin : {0U, 16U, 144U}) {
        const uint32_t end = begin == 16 ? 96 : count;
        CAPTURE(plc::simd_target_name(simd), begin, end, c.along_normal);
        const Streams before(count, -5, 5, 10);
        Streams got = before, twin = before;
        apply(simd, field.view, position, n, c, begin, end, got);
        apply_twin(field.view, position, n, c, begin, end, twin);
        for (size_t a = 0; a < 3; ++a) REQUIRE(first_difference(got.axis[a], twin.axis[a]) == -1);
        for (uint32_t i = 0; i < count; ++i) {
          const Vector own{double{n.axis[0][i]}, double{n.axis[1][i]}, double{n.axis[2][i]}};
          const Vector pull = equation_8(expected_gradient(field.view, position[i]), own, c);
          CAPTURE(i);
          for (size_t a = 0; a < 3; ++a) {
            const double old = double{before.axis[a][i]};
            if (i < begin || i >= end) {
              REQUIRE(double{got.axis[a][i]} == old);
            } else {
              REQUIRE(double{got.axis[a][i]} == Approx(old + pull[a]).margin(1e-5));
            }
          }
        }
      }
    }
  }
}

TEST_CASE("no position makes the gradient force read outside the field", "[kernels]") {
  // The field fills its allocation, so that a sanitizer sees any voxel read outside of it.
  Field field(2, 2, 2, 4);
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
  const auto count = static_cast<uint32_t>(position.size());
  const Streams n = unit_normals(count, 5);
  const kernels::GradientPull c{1.0F, 1.0F, {1, 1, 1}};
  for (const float scale : {1.0F, 1e30F, -1.0F, 0.0F}) {
    for (float& s : field.view.scale) s = scale;
    for (const SimdTarget simd : plc::available_simd_targets()) {
      Streams got(count, 0, 0, 1), twin = got;
      apply(simd, field.view, position, n, c, 0, count, got);
      apply_twin(field.view, position, n, c, 0, count, twin);
      for (size_t a = 0; a < 3; ++a) {
        REQUIRE(first_difference(got.axis[a], twin.axis[a]) == -1);
        for (const float f : got.axis[a]) REQUIRE(std::abs(f) <= 1.00001F);
      }
    }
  }
}

TEST_CASE("one coefficient alone pulls along the normal or along the tangent plane", "[kernels]") {
  Field field(2, 2, 2, 6);
  for (Float4& v : field.vectors) v = {0.5F, -0.25F, 0.75F, 0.0F};
  const std::vector<Float4> position(16, Float4{0.3F, 0.6F, 0.2F, 0.0F});
  Streams n(16, 0, 0, 1);
  n.axis[2].assign(16, 1.0F);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    Streams normal(16, 0, 0, 1), tangent = normal;
    apply(simd, field.view, position, n, {2.0F, 0.0F, {1, 1, 1}}, 0, 16, normal);
    apply(simd, field.view, position, n, {0.0F, 2.0F, {1, 1, 1}}, 0, 16, tangent);
    for (size_t i = 0; i < 16; ++i) {
      REQUIRE(normal.axis[0][i] == 0.0F);
      REQUIRE(normal.axis[1][i] == 0.0F);
      REQUIRE(normal.axis[2][i] == 1.5F);
      REQUIRE(tangent.axis[0][i] == 1.0F);
      REQUIRE(tangent.axis[1][i] == -0.5F);
      REQUIRE(tangent.axis[2][i] == 0.0F);
    }
  }
}
