// Arguments of the C API that a host should not give, and some that it should.
#pragma once
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "engine/pellicle.h"
#include "tests/fuzz/input.h"

namespace fuzz {

inline double random_double(Input& input) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kValues[] = {0,     1,   -1,           0.5,        1e-300, -1e300,
                                1e300, NAN, kInfinity,    -kInfinity, 1e-12,  3e38,
                                1e39,  2,   4294967296.0, 1e-45,      -0.0};
  switch (input.below(3)) {
    case 0:
      return input.one_of(kValues);
    case 1:
      return input.raw<double>();
    default:
      return input.within(-4, 12);
  }
}

inline int random_int(Input& input) {
  constexpr int kValues[] = {0,  1,  -1,  2,   3,    4,    7,         31,
                             32, 33, 256, 257, 1024, 1025, INT32_MAX, INT32_MIN};
  return input.below(4) == 0 ? input.raw<int>() : input.one_of(kValues);
}

template <typename Enum>
Enum random_enum(Input& input, int count) {
  const int value = input.below(8) == 0
                        ? random_int(input)
                        : static_cast<int>(input.below(static_cast<uint32_t>(count)));
  return static_cast<Enum>(value);
}

// Room for `count` values, at least none, that ends where it says: a sanitizer sees what goes
// beyond. Filled with a pattern.
template <typename T>
class Room {
 public:
  explicit Room(int64_t count)
      : count_(count < 0 ? 0 : static_cast<size_t>(count)),
        data_(static_cast<T*>(std::malloc(count_ * sizeof(T)))) {
    if (count_ > 0) std::memset(static_cast<void*>(data_.get()), kPattern, count_ * sizeof(T));
  }
  T* data() { return data_.get(); }
  bool is_untouched() const {
    const auto* bytes = reinterpret_cast<const unsigned char*>(data_.get());
    for (size_t i = 0; i < count_ * sizeof(T); ++i) {
      if (bytes[i] != kPattern) return false;
    }
    return true;
  }

 private:
  static constexpr int kPattern = 0xa5;
  struct Free {
    void operator()(T* data) const { std::free(data); }
  };
  size_t count_;
  std::unique_ptr<T, Free> data_;
};

// A struct as a host passes it that was built with another header: in memory of just struct_size
// bytes where that is less, and with any struct_size.
template <typename T>
class Sized {
 public:
  Sized(Input& input, const T& value) {
    constexpr size_t kSizes[] = {0,
                                 1,
                                 sizeof(size_t),
                                 sizeof(T) / 2 / 8 * 8,
                                 sizeof(T) - 8,
                                 sizeof(T) - 1,
                                 sizeof(T) + 8,
                                 std::numeric_limits<size_t>::max()};
    const size_t said = input.below(8) == 0 ? input.one_of(kSizes) : sizeof(T);
    // struct_size itself can always be read.
    const size_t size = std::max(std::min(said, sizeof(T) + 64), sizeof(size_t));
    bytes_.reset(static_cast<unsigned char*>(std::malloc(size)));
    std::memset(bytes_.get(), 0, size);
    std::memcpy(bytes_.get(), &value, std::min(size, sizeof(T)));
    std::memcpy(bytes_.get(), &said, sizeof said);
    before_.assign(bytes_.get(), bytes_.get() + size);
  }
  T* get() { return reinterpret_cast<T*>(bytes_.get()); }
  bool is_untouched() const {
    return std::memcmp(bytes_.get(), before_.data(), before_.size()) == 0;
  }

 private:
  struct Free {
    void operator()(unsigned char* data) const { std::free(data); }
  };
  std::unique_ptr<unsigned char, Free> bytes_;
  std::vector<unsigned char> before_;
};

// An image whose voxels are where it says, in memory that ends with them - or that must be refused
// before they are looked at.
class RandomImage {
 public:
  explicit RandomImage(Input& input);
  const plc_image& image() const { return image_; }

 private:
  void make_layout(Input& input, int64_t voxel);
  plc_image image_{};
  std::unique_ptr<Room<unsigned char>> voxels_;
};

// Any values, but what makes a run of hours: iterations and bubbles stay few.
plc_parameters random_parameters(Input& input);

}  // namespace fuzz
