// What four.h has of a compiler's vectors, for compilers that have none: the same bits, lane by
// lane.
#pragma once
#include <cmath>
#include <cstdint>
#include <cstring>

#include "kernels/ring.h"

namespace plc {
inline namespace plain {

struct Four {
  float lane[4];
  float operator[](int k) const { return lane[k]; }
};
struct FourInts {
  int32_t lane[4];
  int32_t operator[](int k) const { return lane[k]; }
};

// The result's lane k is of(k).
template <typename Result, typename Of>
inline Result lanes(const Of& of) {
  return {{of(0), of(1), of(2), of(3)}};
}

inline Four operator+(const Four& a, float s) {
  return lanes<Four>([&](int k) { return a[k] + s; });
}
inline Four operator+(const Four& a, const Four& b) {
  return lanes<Four>([&](int k) { return a[k] + b[k]; });
}
inline Four operator-(const Four& a, const Four& b) {
  return lanes<Four>([&](int k) { return a[k] - b[k]; });
}
inline Four operator-(const Four& a, float s) {
  return lanes<Four>([&](int k) { return a[k] - s; });
}
inline Four operator-(float s, const Four& a) {
  return lanes<Four>([&](int k) { return s - a[k]; });
}
inline Four operator*(const Four& a, float s) {
  return lanes<Four>([&](int k) { return a[k] * s; });
}
// Masks: -1 where it holds, else 0.
inline FourInts operator>=(const Four& a, float s) {
  return lanes<FourInts>([&](int k) { return a[k] >= s ? -1 : 0; });
}
inline FourInts operator==(const FourInts& a, int32_t i) {
  return lanes<FourInts>([&](int k) { return a[k] == i ? -1 : 0; });
}
inline FourInts operator|(const FourInts& a, const FourInts& b) {
  return lanes<FourInts>([&](int k) { return a[k] | b[k]; });
}
inline FourInts operator>>(const FourInts& a, int32_t bits) {
  return lanes<FourInts>([&](int k) { return a[k] >> bits; });
}

inline Four load_four(const float* four) {
  Four f;
  std::memcpy(&f, four, sizeof f);
  return f;
}
inline Four load_four(const Float4& p) {
  return {{p.x, p.y, p.z, 0}};
}
inline FourInts load_four(const uint32_t* four) {
  FourInts f;
  std::memcpy(&f, four, sizeof f);
  return f;
}
inline void store_four(const Four& f, float* four) {
  std::memcpy(four, &f, sizeof f);
}
inline void store_four(const FourInts& f, int32_t* four) {
  std::memcpy(four, &f, sizeof f);
}
inline Four min_four(const Four& a, const Four& b) {
  return lanes<Four>([&](int k) { return b[k] < a[k] ? b[k] : a[k]; });
}
inline Four max_four(const Four& a, const Four& b) {
  return lanes<Four>([&](int k) { return a[k] < b[k] ? b[k] : a[k]; });
}
inline FourInts floor_four(const Four& f) {
  return lanes<FourInts>([&](int k) { return static_cast<int32_t>(std::floor(f[k])); });
}
inline uint32_t lane_bits(const FourInts& mask) {
  uint32_t bits = 0;
  for (int k = 0; k < 4; ++k) bits |= (static_cast<uint32_t>(mask[k]) & 1U) << k;
  return bits;
}
inline bool same_four(const Four& a, const Four& b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2] && a[3] == b[3];
}
inline bool overlap_four(const Four& low, const Four& high, const Four& other_low,
                         const Four& other_high) {
  bool apart = false;
  for (int k = 0; k < 4; ++k) {
    apart |= static_cast<bool>(static_cast<int>(low[k] > other_high[k]) |
                               static_cast<int>(other_low[k] > high[k]));
  }
  return !apart;
}

}  // namespace plain
}  // namespace plc
