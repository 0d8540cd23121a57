// 64-bit FNV-1a: what recorded results are compared by. Not a library's hash: it is a line of code,
// must be the same for ever, and is not where the time goes.
#pragma once
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace plc {

// Values byte by byte, the lowest first; floats by their bits.
class Fnv {
 public:
  template <std::unsigned_integral T>
  void add(T value) {
    for (size_t i = 0; i < sizeof(T); ++i) {
      hash_ = (hash_ ^ (value >> (8 * i) & 0xFFU)) * 0x100000001B3ULL;
    }
  }
  void add(float value) { add(bits<uint32_t>(value)); }
  void add(double value) { add(bits<uint64_t>(value)); }
  // Every value of a range, from the first to the last.
  template <typename Range>
  void add_all(const Range& values) {
    for (const auto& value : values) add(value);
  }
  uint64_t value() const { return hash_; }

 private:
  // std::bit_cast, which older libraries of Clang have not.
  template <typename Bits, typename Value>
  static Bits bits(Value value) {
    Bits same;
    static_assert(sizeof same == sizeof value);
    std::memcpy(&same, &value, sizeof same);
    return same;
  }

  uint64_t hash_ = 0xCBF29CE484222325ULL;
};

}  // namespace plc
