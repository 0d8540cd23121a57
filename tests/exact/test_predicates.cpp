#include "engine/exact/predicates.h"
#include "pyramid/memory.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace {

using plc::Point3;

// Integers without bounds: enough to evaluate determinants of doubles exactly. Slow and simple.
class Integer {
 public:
  Integer() = default;
  // value * 2^shift, which must be an integer
  Integer(double value, int shift) {
    int exponent = 0;
    const double mantissa = std::frexp(std::abs(value), &exponent);
    auto bits = static_cast<uint64_t>(std::ldexp(mantissa, 53));
    int up = exponent - 53 + shift;
    while (up < 0 && bits != 0) {
      REQUIRE((bits & 1U) == 0);
      bits >>= 1U;
      ++up;
    }
    negative_ = value < 0;
    digits_.assign(static_cast<size_t>(std::max(up, 0) / 32), 0);
    const auto rest = static_cast<unsigned>(std::max(up, 0) % 32);
    const unsigned __int128 wide = static_cast<unsigned __int128>(bits) << rest;
    for (unsigned k = 0; k < 3; ++k) digits_.push_back(static_cast<uint32_t>(wide >> (32U * k)));
    trim();
  }
  int sign() const { return digits_.empty() ? 0 : (negative_ ? -1 : 1); }
  friend Integer operator*(const Integer& a, const Integer& b) {
    Integer r;
    r.negative_ = a.negative_ != b.negative_;
    r.digits_.assign(a.digits_.size() + b.digits_.size(), 0);
    for (size_t i = 0; i < a.digits_.size(); ++i) {
      uint64_t carry = 0;
      for (size_t j = 0; j < b.digits_.size() || carry != 0; ++j) {
        const uint64_t product =
            j < b.digits_.size() ? static_cast<uint64_t>(a.digits_[i]) * b.digits_[j] : 0;
        carry += product + r.digits_[i + j];
        r.digits_[i + j] = static_cast<uint32_t>(carry);
        carry >>= 32U;
      }
    }
    r.trim();
    return r;
  }
  friend Integer operator-(const Integer& a, const Integer& b) {
    Integer c = b;
    c.negative_ = !b.negative_;
    return a + c;
  }
  friend Integer operator+(const Integer& a, const Integer& b) {
    if (a.negative_ == b.negative_) return magnitude_sum(a, b);
    return less(a, b) ? magnitude_difference(b, a) : magnitude_difference(a, b);
  }

 private:
  static bool less(const Integer& a, const Integer& b) {
    if (a.digits_.size() != b.digits_.size()) return a.digits_.size() < b.digits_.size();
    for (size_t i = a.digits_.size(); i-- > 0;) {
      if (a.digits_[i] != b.digits_[i]) return a.digits_[i] < b.digits_[i];
    }
    return false;
  }
  static uint32_t digit(const Integer& a, size_t i) {
    return i < a.digits_.size() ? a.digits_[i] : 0;
  }
  static Integer magnitude_sum(const Integer& a, const Integer& b) {
    Integer r;
    r.negative_ = a.negative_;
    uint64_t carry = 0;
    for (size_t i = 0; i < std::max(a.digits_.size(), b.digits_.size()) + 1; ++i) {
      carry += static_cast<uint64_t>(digit(a, i)) + digit(b, i);
      r.digits_.push_back(static_cast<uint32_t>(carry));
      carry >>= 32U;
    }
    r.trim();
    return r;
  }
  static Integer magnitude_difference(const Integer& a, const Integer& b) {  // |a| >= |b|
    Integer r;
    r.negative_ = a.negative_;
    int64_t borrow = 0;
    for (size_t i = 0; i < a.digits_.size(); ++i) {
      const int64_t d = static_cast<int64_t>(a.digits_[i]) - digit(b, i) + borrow;
      r.digits_.push_back(static_cast<uint32_t>(d));
      borrow = d < 0 ? -1 : 0;
    }
    r.trim();
    return r;
  }
  void trim() {
    while (!digits_.empty() && digits_.back() == 0) digits_.pop_back();
    if (digits_.empty()) negative_ = false;
  }
  bool negative_ = false;
  plc::Vector<uint32_t> digits_;
};

int exact2(double ax, double ay, double bx, double by, double cx, double cy, int shift = 1100) {
  const auto big = [&](double x) { return Integer(x, shift); };
  const Integer ux = big(bx) - big(ax), uy = big(by) - big(ay);
  const Integer vx = big(cx) - big(ax), vy = big(cy) - big(ay);
  return (ux * vy - uy * vx).sign();
}

int exact3(const Point3& a, const Point3& b, const Point3& c, const Point3& d, int shift = 1100) {
  const auto minus = [&](const Point3& p, double Point3::*axis) {
    return Integer(p.*axis, shift) - Integer(a.*axis, shift);
  };
  const Integer ux = minus(b, &Point3::x), uy = minus(b, &Point3::y), uz = minus(b, &Point3::z);
  const Integer vx = minus(c, &Point3::x), vy = minus(c, &Point3::y), vz = minus(c, &Point3::z);
  const Integer wx = minus(d, &Point3::x), wy = minus(d, &Point3::y), wz = minus(d, &Point3::z);
  return (ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx)).sign();
}

double nudged(double x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, 1e300);
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -1e300);
  return x;
}

Point3 mixed(const Point3& a, const Point3& b, double t) {
  return {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
}

class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  double real(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_()) / 4294967296.0);
  }
  int integer(int low, int high) {
    return low + static_cast<int>(bits_() % static_cast<unsigned>(high - low + 1));
  }
  Point3 point(double size) { return {real(-size, size), real(-size, size), real(-size, size)}; }
  Point3 nudge(const Point3& p, int ulps) {
    return {nudged(p.x, integer(-ulps, ulps)), nudged(p.y, integer(-ulps, ulps)),
            nudged(p.z, integer(-ulps, ulps))};
  }

 private:
  std::mt19937 bits_;
};

struct Tally {
  int signs[3] = {0, 0, 0};
  void count(int s) { ++signs[s + 1]; }
};

}  // namespace

TEST_CASE("the orientation of four points is positive on the side from which three turn left",
          "[predicates]") {
  const Point3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  CHECK(plc::orient3d(a, b, c, {0, 0, 1}) == 1);
  CHECK(plc::orient3d(a, b, c, {0, 0, -1}) == -1);
  CHECK(plc::orient3d(a, b, c, {5, -7, 0}) == 0);
  CHECK(plc::orient2d(0, 0, 1, 0, 0, 1) == 1);
  CHECK(plc::orient2d(0, 0, 0, 1, 1, 0) == -1);
  CHECK(plc::orient2d(0, 0, 1, 1, 2, 2) == 0);
}

TEST_CASE("orient3d is exact for points moved by ulps off a common plane", "[predicates]") {
  Random random(1);
  Tally tally;
  for (int i = 0; i < 4000; ++i) {
    const Point3 a = random.point(10), b = random.point(10), c = random.point(10);
    const Point3 on_plane = mixed(mixed(a, b, random.real(-1, 2)), c, random.real(-1, 2));
    const Point3 d = random.nudge(on_plane, 3);
    const int want = exact3(a, b, c, d);
    tally.count(want);
    REQUIRE(plc::orient3d(a, b, c, d) == want);
    REQUIRE(plc::orient3d_exact(a, b, c, d) == want);
    REQUIRE(plc::orient3d(b, a, c, d) == -want);
    REQUIRE(plc::orient3d(c, d, a, b) == want);
  }
  CHECK(tally.signs[0] > 1000);
  CHECK(tally.signs[2] > 1000);
}

TEST_CASE("orient3d is exact for decimal grids, where differences round", "[predicates]") {
  Random random(2);
  Tally tally;
  for (int i = 0; i < 6000; ++i) {
    Point3 p[4];
    for (Point3& q : p) {
      q = {0.1 * random.integer(-30, 30), 0.1 * random.integer(-30, 30) + 7.7,
           1e-3 * random.integer(-9, 9)};
    }
    if (i % 2 == 0) p[3] = {p[0].x + (p[1].x - p[2].x), p[0].y + (p[1].y - p[2].y), p[1].z};
    const int want = exact3(p[0], p[1], p[2], p[3]);
    tally.count(want);
    REQUIRE(plc::orient3d(p[0], p[1], p[2], p[3]) == want);
    REQUIRE(plc::orient3d_exact(p[0], p[1], p[2], p[3]) == want);
  }
  CHECK(tally.signs[1] > 0);
}

TEST_CASE("orient3d is exact for floats of any size, subnormal ones included", "[predicates]") {
  Random random(3);
  Tally tally;
  const auto any_float = [&] {
    const double x = std::ldexp(random.real(-1, 1), random.integer(-149, 128));
    const auto f = static_cast<float>(x);
    return std::isfinite(f) ? static_cast<double>(f) : 0.0;
  };
  for (int i = 0; i < 1500; ++i) {
    Point3 p[4];
    for (Point3& q : p) q = {any_float(), any_float(), any_float()};
    if (i % 3 == 0) p[3] = {p[0].x, p[0].y, p[1].z};
    if (i % 5 == 0) p[2] = {p[1].x * 2, p[1].y * 2, p[1].z * 2};
    const int want = exact3(p[0], p[1], p[2], p[3]);
    tally.count(want);
    REQUIRE(plc::orient3d(p[0], p[1], p[2], p[3]) == want);
  }
  CHECK(tally.signs[0] > 100);
  CHECK(tally.signs[2] > 100);
}

TEST_CASE("the predicates are exact at the ends of their range", "[predicates]") {
  for (const double size : {4e-90, 1e-60, 1e60, 2.4e89}) {
    Random random(4);
    for (int i = 0; i < 500; ++i) {
      const Point3 a = random.point(size), b = random.point(size), c = random.point(size);
      Point3 d = random.nudge(mixed(mixed(a, b, 0.25), c, random.real(-1, 1)), 2);
      for (double* x : {&d.x, &d.y, &d.z}) {
        if (std::abs(*x) < plc::kPredicateMin) *x = plc::kPredicateMin;
      }
      REQUIRE(plc::orient3d(a, b, c, d) == exact3(a, b, c, d, 1500));
      REQUIRE(plc::orient2d(a.x, a.y, b.x, b.y, d.x, d.y) ==
              exact2(a.x, a.y, b.x, b.y, d.x, d.y, 1500));
    }
  }
}

TEST_CASE("orient2d is exact for points moved by ulps off a common line", "[predicates]") {
  Random random(5);
  Tally tally;
  for (int i = 0; i < 8000; ++i) {
    const Point3 a = random.point(1), b = random.point(1);
    const Point3 c = random.nudge(mixed(a, b, random.real(-3, 3)), 2);
    const int want = exact2(a.x, a.y, b.x, b.y, c.x, c.y);
    tally.count(want);
    REQUIRE(plc::orient2d(a.x, a.y, b.x, b.y, c.x, c.y) == want);
    REQUIRE(plc::orient2d_exact(a.x, a.y, b.x, b.y, c.x, c.y) == want);
    REQUIRE(plc::orient2d(c.x, c.y, b.x, b.y, a.x, a.y) == -want);
  }
  CHECK(tally.signs[0] > 1000);
  CHECK(tally.signs[2] > 1000);
}

TEST_CASE("one plane gives each point the side that orient3d gives", "[predicates]") {
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const Point3 a = random.point(1), b = random.point(1), c = random.point(1);
    const plc::Plane plane(a, b, c);
    for (int k = 0; k < 4; ++k) {
      const Point3 d = random.nudge(mixed(a, mixed(b, c, random.real(0, 1)), 0.5), k);
      REQUIRE(plane.side(d) == exact3(a, b, c, d));
    }
    REQUIRE(plane.side(a) == 0);
    REQUIRE(plane.side(b) == 0);
    REQUIRE(plane.side(c) == 0);
  }
}

TEST_CASE("points are collinear only when exactly so", "[predicates]") {
  CHECK(plc::collinear({0, 0, 0}, {1, 2, 3}, {2, 4, 6}));
  CHECK(plc::collinear({1, 1, 1}, {1, 1, 1}, {2, 4, 6}));
  CHECK(plc::collinear({0, 0, 0.1}, {0, 0, 0.2}, {0, 0, 0.7}));
  CHECK_FALSE(plc::collinear({0, 0, 0}, {1, 2, 3}, {2, 4, nudged(6, 1)}));
  CHECK_FALSE(plc::collinear({0, 0, 0}, {1, 0, 0}, {2, 0, 1e-80}));
}
