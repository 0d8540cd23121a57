#include "kernels/integrate.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "kernels/scalar.h"
#include "pyramid/memory.h"
#include "tests/samples/kernel_fixtures.h"

namespace {

using namespace fixtures;
using plc::Blocks;
using plc::Float4;
using plc::SimdTarget;
using plc::kernels::ConstFloat3s;
using plc::kernels::Float3s;
using plc::kernels::MoveBound;
using plc::kernels::Movement;
using plc::kernels::MoveStreams;
using plc::kernels::Rk4Coefficients;
using plc::kernels::Rk4Streams;
namespace kernels = plc::kernels;
namespace scalar = plc::kernels::scalar;

// The streams of a step; p in records of four too.
struct Particles {
  std::vector<float> p[3], v[3], f[3], s[3], d[3], a[3];
  std::vector<Float4> start, stage;

  Particles(uint32_t count, uint32_t seed) : start(count), stage(count, Float4{7, 7, 7, 7}) {
    for (uint32_t axis = 0; axis < 3; ++axis) {
      for (std::vector<float>* stream :
           {&p[axis], &v[axis], &f[axis], &s[axis], &d[axis], &a[axis]}) {
        *stream = random_floats(count, -3.0F, 3.0F, ++seed);
      }
    }
    pack();
  }
  void pack() {
    for (size_t i = 0; i < start.size(); ++i) start[i] = {p[0][i], p[1][i], p[2][i], 0.0F};
  }
  Blocks blocks() const { return Blocks::range(0, static_cast<uint32_t>(start.size())); }
  Rk4Streams streams() {
    return {start.data(), fixed(v), three(s), three(d), three(a), stage.data()};
  }
  static Float3s three(std::vector<float> (&of)[3]) {
    return {of[0].data(), of[1].data(), of[2].data()};
  }
  static ConstFloat3s fixed(const std::vector<float> (&of)[3]) {
    return {of[0].data(), of[1].data(), of[2].data()};
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
    all.pack();
    all.stage = all.start;
    for (int stage = 0; stage < 4; ++stage) {
      for (uint32_t i = 0; i < plc::kRingLanes; ++i) {
        all.f[0][i] = -stiffness * all.stage[i].x;
        all.f[1][i] = -stiffness * all.stage[i].y;
        all.f[2][i] = -stiffness * all.stage[i].z;
      }
      kernels::rk4_stage(simd, stage, c, all.streams(), Particles::fixed(all.f), all.blocks());
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
        const Blocks blocks = Blocks::range(begin, end);
        kernels::rk4_stage(simd, stage, c, got.streams(), Particles::fixed(got.f), blocks);
        scalar::rk4_stage(stage, c, twin.streams(), Particles::fixed(twin.f), blocks);
        REQUIRE(first_difference(got.all(), twin.all()) == -1);
        for (uint32_t i = 0; i < 80; ++i) {
          const bool in_range = i >= begin && i < end;
          REQUIRE((got.a[0][i] != before.a[0][i]) == in_range);
          REQUIRE((got.d[0][i] != before.d[0][i]) == (in_range && stage != 0));
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
      const ConstFloat3s moved{dx.data(), dy.data(), dz.data()};
      const float got = kernels::max_squared(simd, moved, Blocks::range(16, 64));
      REQUIRE(got == 0.0625F + 0.25F + 9.0F);
      REQUIRE(got == scalar::max_squared(moved, Blocks::range(16, 64)));
    }
    const float none = 0.0F;
    REQUIRE(kernels::max_squared(simd, {&none, &none, &none}, Blocks()) == 0.0F);
  }
}

namespace {

// move() with its streams.
struct Mover {
  Particles all;
  std::vector<Float4> moved_to;
  std::vector<float> path;
  std::vector<uint8_t> turns;  // of all numbers, and sides
  Movement movement;

  explicit Mover(uint32_t count) : all(count, 40), moved_to(count, Float4{7, 7, 7, 7}) {
    path = random_floats(count, 0, 4, 61);
    for (uint32_t v = 0; v < count; ++v) turns.push_back(static_cast<uint8_t>(37 * v));
    for (auto& axis : all.d) axis[20] = 0.0F;
  }
  template <typename Move>
  void run(const Move& move, const MoveBound& bound, const Blocks& blocks) {
    const MoveStreams ends{all.start.data(),        moved_to.data(), Particles::three(all.v),
                           Particles::fixed(all.f), path.data(),     turns.data()};
    movement = move(bound, Particles::three(all.d), Particles::fixed(all.a), ends, blocks);
  }
};

constexpr MoveBound kBound{1.5F, 2.5F, 20, 10, 0.7F};

}  // namespace

TEST_CASE("the move has the bits of its scalar twin, on the listed blocks only", "[kernels]") {
  const plc::Vector<uint32_t> list = {1, 2, 4};
  const Blocks blocks{list.data(), list.size()};
  Mover twin(96);
  twin.run(scalar::move, kBound, blocks);
  REQUIRE(twin.moved_to[3 * plc::kRingLanes].w == 7);
  for (const SimdTarget simd : plc::available_simd_targets()) {
    CAPTURE(plc::simd_target_name(simd));
    Mover got(96);
    got.run([&](const auto&... a) { return kernels::move(simd, a...); }, kBound, blocks);
    CHECK(first_difference(got.all.all(), twin.all.all()) == -1);
    CHECK(first_difference(flatten(got.moved_to), flatten(twin.moved_to)) == -1);
    CHECK(first_difference(got.path, twin.path) == -1);
    CHECK(got.movement.energy == twin.movement.energy);
    CHECK(got.movement.longest2 == twin.movement.longest2);
  }
}

TEST_CASE(
    "movements longer than the bound are shortened, the others keep their bits; each turn "
    "beyond the free ones halves it, and beyond the swinging ones no velocity is left",
    "[kernels]") {
  const Mover before(80);
  Mover after(80);
  after.run(scalar::move, kBound, Blocks::range(0, 80));
  int shortened = 0;
  for (uint32_t i = 0; i < 80; ++i) {
    CAPTURE(i);
    const auto check = [&](const std::vector<float>(&own)[3], const std::vector<float>(&old)[3],
                           float free_bound) {
      const uint32_t turns = after.turns[i] & kernels::kTurnsMask;
      const uint32_t beyond = turns > 20 ? turns - 20 : 0;
      const float bound =
          beyond < kernels::kSlowingTurns ? std::ldexp(free_bound, -static_cast<int>(beyond)) : 0;
      const double length = std::hypot(double{own[0][i]}, double{own[1][i]}, double{own[2][i]});
      const double was = std::hypot(double{old[0][i]}, double{old[1][i]}, double{old[2][i]});
      if (was <= double{bound}) {
        for (int a = 0; a < 3; ++a) REQUIRE(own[a][i] == old[a][i]);
        return;
      }
      ++shortened;
      REQUIRE(length == Approx(double{bound}).epsilon(1e-6).margin(1e-9));
      for (int a = 0; a < 3; ++a) {
        REQUIRE(double{own[a][i]} * was == Approx(double{old[a][i]} * length).margin(1e-5));
      }
    };
    check(after.all.d, before.all.d, kBound.length);
    const bool swings = (after.turns[i] & kernels::kTurnsMask) <= kBound.swinging_turns;
    check(after.all.v, before.all.a, swings ? kBound.speed : 0);
  }
  REQUIRE(shortened > 40);
}

TEST_CASE("moving adds the displacement, lengthens the path and measures the movement",
          "[kernels]") {
  const Mover before(4096);
  Mover after(4096);
  after.turns.assign(4096, 20);
  constexpr double kCounted = 1.25;
  after.run(scalar::move, {100, 100, 20, 20, static_cast<float>(kCounted)},
            Blocks::range(32, 4080));
  int limited = 0;
  double energy = 0, longest = 0;
  for (uint32_t i = 32; i < 4080; ++i) {
    const auto& d = before.all.d;
    const double length = std::hypot(double{d[0][i]}, double{d[1][i]}, double{d[2][i]});
    CAPTURE(i);
    REQUIRE(after.moved_to[i].x == before.all.p[0][i] + d[0][i]);
    REQUIRE(after.moved_to[i].y == before.all.p[1][i] + d[1][i]);
    REQUIRE(after.moved_to[i].z == before.all.p[2][i] + d[2][i]);
    REQUIRE(after.moved_to[i].w == 0.0F);
    REQUIRE(double{after.path[i]} == Approx(double{before.path[i]} + length).margin(1e-5));
    double along = 0;
    for (int a = 0; a < 3; ++a) along += double{d[a][i]} * double{before.all.f[a][i]};
    limited += std::abs(along) > kCounted ? 1 : 0;
    along = std::min(std::abs(along), kCounted);
    energy += along * along;
    longest = std::max(longest, length);
  }
  CHECK(after.movement.energy == Approx(energy).epsilon(1e-6));
  CHECK((limited > 500 && limited < 3500));
  CHECK(double{after.movement.longest2} == Approx(longest * longest).epsilon(1e-6));
  CHECK(after.path[31] == before.path[31]);
}
