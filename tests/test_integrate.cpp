#include "kernels/integrate.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include "kernel_fixtures.h"
#include "kernels/scalar.h"

namespace {

using namespace fixtures;
using plc::Packed;
using plc::SimdTarget;
using plc::kernels::Rk4Coefficients;
using plc::kernels::Rk4Streams;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

// The seven vector streams of Rk4Streams and its packed positions.
struct Particles {
  std::vector<float> p[3], v[3], f[3], s[3], d[3], a[3];
  std::vector<Packed> stage;

  Particles(uint32_t count, uint32_t seed) : stage(count, Packed{7, 7, 7, 7}) {
    for (uint32_t axis = 0; axis < 3; ++axis) {
      for (std::vector<float>* stream :
           {&p[axis], &v[axis], &f[axis], &s[axis], &d[axis], &a[axis]}) {
        *stream = random_floats(count, -3.0F, 3.0F, ++seed);
      }
    }
  }
  Rk4Streams streams() {
    return {p[0].data(), p[1].data(), p[2].data(), v[0].data(), v[1].data(),
            v[2].data(), f[0].data(), f[1].data(), f[2].data(), s[0].data(),
            s[1].data(), s[2].data(), d[0].data(), d[1].data(), d[2].data(),
            a[0].data(), a[1].data(), a[2].data(), stage.data()};
  }
  std::vector<float> all() const {
    std::vector<float> values = flatten(stage);
    for (const auto* group : {&p, &v, &f, &s, &d, &a}) {
      for (const std::vector<float>& stream : *group) {
        values.insert(values.end(), stream.begin(), stream.end());
      }
    }
    return values;
  }
};

// One vertex block under f = -k x on every axis; returns the position on x after `steps`.
double oscillate(SimdTarget simd, const Rk4Coefficients& c, float stiffness, int steps) {
  Particles all(plc::kRingLanes, 1);
  for (uint32_t axis = 0; axis < 3; ++axis) {
    std::fill(all.p[axis].begin(), all.p[axis].end(), axis == 0 ? 1.0F : 0.5F);
    std::fill(all.v[axis].begin(), all.v[axis].end(), 0.0F);
  }
  for (int step = 0; step < steps; ++step) {
    for (uint32_t i = 0; i < plc::kRingLanes; ++i) {
      all.stage[i] = {all.p[0][i], all.p[1][i], all.p[2][i], 0.0F};
    }
    for (int stage = 0; stage < 4; ++stage) {
      for (uint32_t i = 0; i < plc::kRingLanes; ++i) {
        all.f[0][i] = -stiffness * all.stage[i].x;
        all.f[1][i] = -stiffness * all.stage[i].y;
        all.f[2][i] = -stiffness * all.stage[i].z;
      }
      kernels::rk4_stage(simd, stage, c, all.streams(), 0, plc::kRingLanes);
    }
    for (uint32_t axis = 0; axis < 3; ++axis) {
      for (uint32_t i = 0; i < plc::kRingLanes; ++i) all.p[axis][i] += all.d[axis][i];
      all.v[axis] = all.a[axis];
    }
  }
  REQUIRE(all.p[1][3] == Approx(0.5F * all.p[0][3]).margin(1e-5));
  REQUIRE(all.p[2][15] == Approx(0.5F * all.p[0][3]).margin(1e-5));
  return double{all.p[0][0]};
}

}  // namespace

TEST_CASE("every Runge-Kutta stage has the bits of its scalar twin", "[kernels]") {
  const Rk4Coefficients c{1.0F / 0.7F, 0.45F, 0.9F};
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (int stage = 0; stage < 4; ++stage) {
      for (const uint32_t begin : {0U, 16U, 48U}) {
        const uint32_t end = begin == 16 ? 48 : 80;
        CAPTURE(plc::simd_target_name(simd), stage, begin, end);
        Particles got(80, 20);
        Particles twin(80, 20);
        const Particles before(80, 20);
        kernels::rk4_stage(simd, stage, c, got.streams(), begin, end);
        scalar::rk4_stage(stage, c, twin.streams(), begin, end);
        REQUIRE(first_difference(got.all(), twin.all()) == -1);
        for (uint32_t i = 0; i < 80; ++i) {
          const bool in_range = i >= begin && i < end;
          REQUIRE((got.d[0][i] != before.d[0][i]) == in_range);
          REQUIRE((got.stage[i].w == 0.0F) == (in_range && stage != 3));
        }
      }
    }
  }
}

TEST_CASE("Runge-Kutta follows a damped oscillator with fourth order", "[kernels]") {
  // m x'' + gamma x' + k x = 0 from rest at 1: exp(-b t) (cos w t + b/w sin w t).
  const double m = 2.0, gamma = 0.6, k = 3.0, t = 6.0;
  const double b = gamma / (2 * m), w = std::sqrt(k / m - b * b);
  const double exact = std::exp(-b * t) * (std::cos(w * t) + b / w * std::sin(w * t));
  for (const SimdTarget simd : plc::available_simd_targets()) {
    const auto error = [&](int steps) {
      const Rk4Coefficients c{static_cast<float>(1 / m), static_cast<float>(gamma),
                              static_cast<float>(t / steps)};
      return std::abs(oscillate(simd, c, static_cast<float>(k), steps) - exact);
    };
    const double coarse = error(10), fine = error(20);
    CAPTURE(plc::simd_target_name(simd), coarse, fine);
    REQUIRE(fine < 5e-4);
    REQUIRE(std::log2(coarse / fine) == Approx(4.0).margin(0.5));
  }
}

TEST_CASE("the longest squared displacement is found in any lane and NaN is passed over",
          "[kernels]") {
  for (const SimdTarget simd : plc::available_simd_targets()) {
    for (uint32_t place = 16; place < 64; ++place) {
      std::vector<float> dx(80, 0.25F), dy(80, -0.5F), dz(80, 0.125F);
      dx[0] = dy[79] = 100.0F;  // outside the range
      dz[place] = -3.0F;
      dx[(place - 16 + 5) % 48 + 16] = std::nanf("");
      const float got = kernels::max_squared(simd, dx.data(), dy.data(), dz.data(), 16, 64);
      REQUIRE(got == 0.0625F + 0.25F + 9.0F);
      REQUIRE(got == scalar::max_squared(dx.data(), dy.data(), dz.data(), 16, 64));
    }
    const float none = 0.0F;
    REQUIRE(kernels::max_squared(simd, &none, &none, &none, 0, 0) == 0.0F);
  }
}

TEST_CASE("movements longer than the bound are shortened, the others keep their bits",
          "[kernels]") {
  const float max_length = 1.5F, max_speed = 2.5F;
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    Particles got(80, 40);
    Particles twin(80, 40);
    got.d[0][20] = got.d[1][20] = got.d[2][20] = 0.0F;
    twin.d[0][20] = twin.d[1][20] = twin.d[2][20] = 0.0F;
    const Particles before = got;
    kernels::clamp_movement(simd, max_length, max_speed, got.d[0].data(), got.d[1].data(),
                            got.d[2].data(), got.v[0].data(), got.v[1].data(), got.v[2].data(), 16,
                            64);
    scalar::clamp_movement(max_length, max_speed, twin.d[0].data(), twin.d[1].data(),
                           twin.d[2].data(), twin.v[0].data(), twin.v[1].data(), twin.v[2].data(),
                           16, 64);
    REQUIRE(first_difference(got.all(), twin.all()) == -1);
    int shortened = 0;
    for (uint32_t i = 0; i < 80; ++i) {
      CAPTURE(i);
      const auto check = [&](const std::vector<float>(&own)[3], const std::vector<float>(&old)[3],
                             float bound) {
        const double length = std::hypot(double{own[0][i]}, double{own[1][i]}, double{own[2][i]});
        const double was = std::hypot(double{old[0][i]}, double{old[1][i]}, double{old[2][i]});
        if (i < 16 || i >= 64 || was <= double{bound}) {
          for (int a = 0; a < 3; ++a) REQUIRE(own[a][i] == old[a][i]);
          return;
        }
        ++shortened;
        REQUIRE(length == Approx(double{bound}).epsilon(1e-6));
        for (int a = 0; a < 3; ++a) {
          REQUIRE(double{own[a][i]} * was == Approx(double{old[a][i]} * length).margin(1e-5));
        }
      };
      check(got.d, before.d, max_length);
      check(got.v, before.v, max_speed);
    }
    REQUIRE(shortened > 40);
  }
}

TEST_CASE("moving adds the displacement and lengthens the path", "[kernels]") {
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    Particles got(80, 60);
    Particles twin(80, 60);
    const Particles before(80, 60);
    std::vector<float> path = random_floats(80, 0, 4, 61);
    const std::vector<float> path_before = path;
    std::vector<float> twin_path = path;
    kernels::move(simd, got.d[0].data(), got.d[1].data(), got.d[2].data(), got.p[0].data(),
                  got.p[1].data(), got.p[2].data(), got.stage.data(), path.data(), 16, 64);
    scalar::move(twin.d[0].data(), twin.d[1].data(), twin.d[2].data(), twin.p[0].data(),
                 twin.p[1].data(), twin.p[2].data(), twin.stage.data(), twin_path.data(), 16, 64);
    REQUIRE(first_difference(got.all(), twin.all()) == -1);
    REQUIRE(first_difference(path, twin_path) == -1);
    for (uint32_t i = 0; i < 80; ++i) {
      const bool in_range = i >= 16 && i < 64;
      const double length =
          std::hypot(double{before.d[0][i]}, double{before.d[1][i]}, double{before.d[2][i]});
      CAPTURE(i);
      REQUIRE(got.p[1][i] == before.p[1][i] + (in_range ? before.d[1][i] : 0.0F));
      REQUIRE(double{path[i]} ==
              Approx(double{path_before[i]} + (in_range ? length : 0.0)).margin(1e-5));
      if (!in_range) continue;
      REQUIRE(got.stage[i].x == got.p[0][i]);
      REQUIRE(got.stage[i].y == got.p[1][i]);
      REQUIRE(got.stage[i].z == got.p[2][i]);
      REQUIRE(got.stage[i].w == 0.0F);
    }
  }
}

TEST_CASE("the energy along the normals has the same bits for every target", "[kernels]") {
  Particles all(4096, 80);
  double expected = 0;
  for (uint32_t i = 32; i < 4080; ++i) {
    double along = 0;
    for (int a = 0; a < 3; ++a) along += double{all.d[a][i]} * double{all.f[a][i]};
    expected += along * along;
  }
  const double twin =
      scalar::normal_energy_sum(all.d[0].data(), all.d[1].data(), all.d[2].data(), all.f[0].data(),
                                all.f[1].data(), all.f[2].data(), 32, 4080);
  REQUIRE(twin == Approx(expected).epsilon(1e-6));
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    REQUIRE(kernels::normal_energy_sum(simd, all.d[0].data(), all.d[1].data(), all.d[2].data(),
                                       all.f[0].data(), all.f[1].data(), all.f[2].data(), 32,
                                       4080) == twin);
  }
}
