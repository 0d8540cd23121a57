// Registered a second time with a C library that does not use multiply-add: the same hash.
#include "pyramid/exponential.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "engine/base/fnv.h"

namespace {

using plc::exponential;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Over all that has a result, and, as often, over what a Gaussian asks for.
std::vector<double> arguments(size_t count) {
  std::mt19937_64 bits(16);
  const auto unit = [&] { return static_cast<double>(bits() >> 11) * 0x1p-53; };
  std::vector<double> all;
  while (all.size() < count) {
    all.push_back(-708.39 + 1418.17 * unit());
    all.push_back(-5 * unit());
  }
  return all;
}

double ulp(double y) {
  return std::nextafter(y, kInfinity) - y;
}

}  // namespace

TEST_CASE("e^x is the nearest double, but for a thousandth of a step", "[exponential]") {
  // Nothing better to compare with: a library may compute more digits no better.
  if (std::numeric_limits<long double>::digits < 64) return;
  if (std::exp(1.5L) == static_cast<long double>(std::exp(1.5))) return;
  double worst = 0;
  for (const double x : arguments(200000)) {
    const double got = exponential(x);
    const long double off = std::exp(static_cast<long double>(x)) - static_cast<long double>(got);
    worst = std::max(worst, std::abs(static_cast<double>(off)) / ulp(got));
  }
  CHECK(worst > 0.49);  // else too few were looked at
  CHECK(worst < 0.501);
}

TEST_CASE("e^x has its recorded bits, whatever the C library does", "[exponential]") {
  plc::Fnv hash;
  for (const double x : arguments(200000)) hash.add(exponential(x));
  CHECK(hash.value() == 0xbc65993f79359fe8);
}

// Computed apart, in 70 digits. The results lie between two doubles, nearer to the middle than
// a fifth of a millionth of the step from one to the other.
TEST_CASE("e^x is rounded correctly where that is hard", "[exponential]") {
  constexpr double kHard[][2] = {{-0x1.af1d820d88e21p+1, 0x1.1a42525a77cecp-5},
                                 {-0x1.195e8d19eff37p+2, 0x1.93c1a466ffb8bp-7},
                                 {0x1.05bc952e2be20p+8, 0x1.85afa7de8b791p+377},
                                 {-0x1.172dd6768ab72p+2, 0x1.a1d03cfb5a7e8p-7},
                                 {-0x1.5a70dfd030fc1p+0, 0x1.08976a01df3c8p-2},
                                 {-0x1.9e18a98e6b612p-2, 0x1.55b33ea81349dp-1},
                                 {-0x1.28efbd755c5c6p+2, 0x1.3c94697b1f95fp-7},
                                 {-0x1.2d40cab01bb8bp+0, 0x1.3babe3346418bp-2}};
  for (const auto& [x, y] : kHard) CHECK(exponential(x) == y);
}

TEST_CASE("e^x at its ends", "[exponential]") {
  CHECK(exponential(0) == 1);
  CHECK(exponential(-0.0) == 1);
  CHECK(exponential(5e-324) == 1);
  CHECK(exponential(-1e-300) == 1);
  CHECK(exponential(0x1p-53) == 1);  // the middle between 1 and what follows, and less
  CHECK(exponential(0x1.8p-53) == 1 + 0x1p-52);
  CHECK(exponential(kInfinity) == kInfinity);
  CHECK(exponential(1e300) == kInfinity);
  CHECK(exponential(-kInfinity) == 0);
  CHECK(exponential(-1e300) == 0);
  CHECK(std::isnan(exponential(std::nan(""))));
  const double largest = 709.782712893384, smallest = -708.3964185322641;
  CHECK(std::isfinite(exponential(largest)));
  CHECK(exponential(std::nextafter(largest, kInfinity)) == kInfinity);
  CHECK(std::isnormal(exponential(smallest)));
  CHECK(exponential(std::nextafter(smallest, -kInfinity)) == 0);
}

TEST_CASE("e^x never falls as x grows", "[exponential]") {
  std::mt19937_64 bits(17);
  // Neighbours, across the places where another power of 2 is taken out, and anywhere.
  for (int i = -2000; i <= 2000; ++i) {
    const double middle = i % 2 == 0 ? 0.34657359027997264 * i
                                     : -700 + 1400 * static_cast<double>(bits() >> 11) * 0x1p-53;
    if (std::abs(middle) > 700) continue;
    double x = middle;
    for (int k = 0; k < 20; ++k) x = std::nextafter(x, -kInfinity);
    double before = exponential(x);
    for (int k = 0; k < 40; ++k) {
      x = std::nextafter(x, kInfinity);
      const double here = exponential(x);
      REQUIRE(here >= before);
      before = here;
    }
  }
}
