// Reduction, halving and squaring as in Y. Hida, X. S. Li, D. H. Bailey, "Algorithms for
// Quad-Double Precision Floating Point Arithmetic", ARITH-15, 2001, in two doubles.
#include "pyramid/exponential.h"

#include <cmath>
#include <limits>

#include "pyramid/two_doubles.h"

namespace plc {

namespace {

// Logarithms of the smallest normal number, from above, and of the largest, from below.
constexpr double kSmallest = -708.3964185322641;
constexpr double kLargest = 709.782712893384;

// ln 2 in three parts; the first two have 42 bits: times a power of x, which has 11, they are
// exact.
constexpr double kLn2[] = {0x1.62e42fefa38p-1, 0x1.ef35793c76p-45, 0x1.cc01f97b57a08p-87};

// What is left of x after powers of 2, at most ln 2 / 2, is halved so often; the series then needs
// so many terms: what it leaves out is below 2^-120, and below 2^-110 when it has been squared.
constexpr int kHalvings = 9;
constexpr int kTerms = 10;

TwoDoubles add(TwoDoubles a, double b) {
  const TwoDoubles s = two_sum(a.hi, b);
  return fast_two_sum(s.hi, s.lo + a.lo);
}

TwoDoubles add(TwoDoubles a, TwoDoubles b) {
  const TwoDoubles s = two_sum(a.hi, b.hi), t = two_sum(a.lo, b.lo);
  const TwoDoubles u = fast_two_sum(s.hi, s.lo + t.hi);
  return fast_two_sum(u.hi, u.lo + t.lo);
}

TwoDoubles multiply(TwoDoubles a, TwoDoubles b) {
  const TwoDoubles p = two_product(a.hi, b.hi);
  return fast_two_sum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

TwoDoubles divide(TwoDoubles a, double n) {
  const double q = a.hi / n;
  const TwoDoubles p = two_product(q, n);
  return fast_two_sum(q, (((a.hi - p.hi) - p.lo) + a.lo) / n);
}

// e^t - 1 by its series, t + t^2 / 2 + t^3 / 6 ...
TwoDoubles series(TwoDoubles t) {
  TwoDoubles sum{1, 0};
  for (int n = kTerms; n > 1; --n) sum = add(divide(multiply(t, sum), n), 1);
  return multiply(t, sum);
}

}  // namespace

double exponential(double x) {
  if (std::isnan(x)) return x;
  if (x < kSmallest) return 0;
  if (x > kLargest) return std::numeric_limits<double>::infinity();
  const double power = std::floor(x / kLn2[0] + 0.5);
  TwoDoubles rest = two_sum(x, -power * kLn2[0]);
  rest = add(rest, -power * kLn2[1]);
  rest = add(rest, -power * kLn2[2]);
  constexpr double kScale = 1.0 / (1 << kHalvings);
  TwoDoubles less_one = series({rest.hi * kScale, rest.lo * kScale});
  // (1 + a)^2 - 1 = 2 a + a^2: e^t itself would lose the bits of what is added to 1.
  for (int i = 0; i < kHalvings; ++i) {
    less_one = add({2 * less_one.hi, 2 * less_one.lo}, multiply(less_one, less_one));
  }
  return std::ldexp(add(less_one, 1).hi, static_cast<int>(power));
}

}  // namespace plc
