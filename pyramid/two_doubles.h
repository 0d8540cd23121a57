// Sums and products of doubles without their rounding errors: T. J. Dekker, "A Floating-Point
// Technique for Extending the Available Precision", Numerische Mathematik 18, 1971.
#pragma once

namespace plc {

struct TwoDoubles {
  double hi, lo;  // hi + lo exactly, hi the rounded result
};

inline TwoDoubles two_sum(double a, double b) {
  const double hi = a + b;
  const double virtual_b = hi - a;
  return {hi, (a - (hi - virtual_b)) + (b - virtual_b)};
}

// Requires |a| >= |b| or a == 0.
inline TwoDoubles fast_two_sum(double a, double b) {
  const double hi = a + b;
  return {hi, b - (hi - a)};
}

// Dekker's splitting: std::fma is a slow library call where the target has no such instruction.
inline TwoDoubles split(double a) {
  constexpr double kSplitter = 134217729.0;  // 2^27 + 1
  const double c = kSplitter * a;
  const double hi = c - (c - a);
  return {hi, a - hi};
}

inline TwoDoubles two_product(double a, double b) {
  const double hi = a * b;
  const TwoDoubles s = split(a), t = split(b);
  return {hi, s.lo * t.lo - (((hi - s.hi * t.hi) - s.lo * t.hi) - s.hi * t.lo)};
}

}  // namespace plc
