// Random numbers of the phantoms: the same on every machine, unlike the distributions of std.
#pragma once
#include <cstdint>

namespace plc::tools {

// splitmix64: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}

  uint64_t next() {
    state_ += 0x9e3779b97f4a7c15U;
    uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  // In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  // Mean 0, variance 1, within +-6: the sum of twelve uniform values (16 bits each), which needs no
  // logarithm or cosine whose last bit differs between libraries.
  double normal() {
    uint64_t sum = 0;
    for (int i = 0; i < 3; ++i) {
      const uint64_t bits = next();
      sum += (bits & 0xffffU) + ((bits >> 16) & 0xffffU) + ((bits >> 32) & 0xffffU) + (bits >> 48);
    }
    return static_cast<double>(sum) * 0x1p-16 - (6.0 - 12 * 0x1p-17);
  }

 private:
  uint64_t state_;
};

}  // namespace plc::tools
