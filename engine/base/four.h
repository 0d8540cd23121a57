// Four floats at once where there is no kernel: GCC and Clang make what they have of it.
#pragma once
// The tests define PLC_PLAIN_FOUR.
#if !defined(__GNUC__) || defined(PLC_PLAIN_FOUR)
#include "engine/base/four_plain.h"
#else
#include <cstdint>
#include <cstring>

#include "kernels/ring.h"

namespace plc {

using Four = float __attribute__((vector_size(16)));
using FourInts = int32_t __attribute__((vector_size(16)));

inline Four load_four(const float* four) {
  Four f;
  std::memcpy(&f, four, sizeof f);
  return f;
}
// The place alone: 0 instead of w.
inline Four load_four(const Float4& p) {
  constexpr FourInts kPlace{-1, -1, -1, 0};
  FourInts bits;
  std::memcpy(&bits, &p, sizeof bits);
  bits &= kPlace;
  Four f;
  std::memcpy(&f, &bits, sizeof f);
  return f;
}
inline FourInts load_four(const uint32_t* four) {
  FourInts f;
  std::memcpy(&f, four, sizeof f);
  return f;
}
inline void store_four(Four f, float* four) {
  std::memcpy(four, &f, sizeof f);
}
inline void store_four(FourInts f, int32_t* four) {
  std::memcpy(four, &f, sizeof f);
}
inline Four min_four(Four a, Four b) {
  return b < a ? b : a;
}
inline Four max_four(Four a, Four b) {
  return a < b ? b : a;
}

// Rounded down; within the range of int32_t.
inline FourInts floor_four(Four f) {
  const FourInts toward_zero = __builtin_convertvector(f, FourInts);
  return toward_zero + (__builtin_convertvector(toward_zero, Four) > f);
}

// Bit k for each lane k of a mask that is set.
inline uint32_t lane_bits(FourInts mask) {
  constexpr FourInts kBits{1, 2, 4, 8};
  mask &= kBits;
  uint64_t halves[2];
  std::memcpy(halves, &mask, sizeof halves);
  const uint64_t pairs = halves[0] | halves[1];
  return static_cast<uint32_t>(pairs | pairs >> 32);
}
// Whether no lane of a mask is set.
inline bool no_lane(FourInts mask) {
  uint64_t halves[2];
  std::memcpy(halves, &mask, sizeof halves);
  return (halves[0] | halves[1]) == 0;
}
inline bool same_four(Four a, Four b) {
  return no_lane(a != b);
}

// Whether [low, high] and [other_low, other_high] overlap in every lane; closed.
inline bool overlap_four(Four low, Four high, Four other_low, Four other_high) {
  return no_lane((low > other_high) | (other_low > high));
}

}  // namespace plc
#endif
