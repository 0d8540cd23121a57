// Sizes computed from what a file says: 2^64 - 1, which nothing has, where they do not fit.
#pragma once
#include <cstdint>
#include <limits>

namespace plc::tools {

constexpr uint64_t kTooLarge = std::numeric_limits<uint64_t>::max();

constexpr uint64_t plus(uint64_t a, uint64_t b) {
  return a > kTooLarge - b ? kTooLarge : a + b;
}

constexpr uint64_t times(uint64_t a, uint64_t b) {
  return b != 0 && a > kTooLarge / b ? kTooLarge : a * b;
}

}  // namespace plc::tools
