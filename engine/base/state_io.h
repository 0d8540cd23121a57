// The state of a run as bytes: written and read in the same order, field by field.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace plc {

// Writes values as they lie in memory: only the same version of the library, on a machine of the
// same byte order, reads them (api_run_state.cpp).
class StateWriter {
 public:
  // Writes nothing, and counts the bytes.
  StateWriter() = default;
  // to: room for as many bytes as were counted.
  explicit StateWriter(uint8_t* to) : to_(to) {}
  template <typename T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    add_bytes(&value, sizeof value);
  }
  // The number of values, then these.
  template <typename Range>
  void add_all(const Range& values) {
    add_some(values, values.size());
  }
  // The first `count` of them, likewise.
  template <typename Range>
  void add_some(const Range& values, size_t count) {
    static_assert(std::is_trivially_copyable_v<std::remove_cvref_t<decltype(*values.data())>>);
    add(static_cast<uint64_t>(count));
    add_bytes(values.data(), count * sizeof(*values.data()));
  }
  // How many bytes have been added so far.
  size_t size() const { return size_; }
  // The first of them; null where they are only counted.
  const uint8_t* data() const { return to_; }

 private:
  void add_bytes(const void* data, size_t size) {
    if (to_ != nullptr && size != 0) std::memcpy(to_ + size_, data, size);
    size_ += size;
  }
  uint8_t* to_ = nullptr;
  size_t size_ = 0;
};

// Bytes from elsewhere: nothing beyond their end is read, no more is allocated than there are. What
// cannot be read leaves the value and makes ok() false from then on.
class StateReader {
 public:
  StateReader(const uint8_t* data, size_t size) : data_(data), left_(size) {}

  template <typename T>
  void read(T& value) {
    static_assert(std::is_arithmetic_v<T>);
    if (!take(sizeof value)) return;
    if constexpr (std::is_same_v<T, bool>) {
      value = *(data_ - 1) != 0;
    } else {
      std::memcpy(&value, data_ - sizeof value, sizeof value);
    }
  }
  // An enum whose values are 0 .. last.
  template <typename T>
  void read(T& value, T last) {
    std::underlying_type_t<T> number{};
    read(number);
    if (number < 0 || number > static_cast<std::underlying_type_t<T>>(last)) ok_ = false;
    if (ok_) value = static_cast<T>(number);
  }
  template <typename Range>
  void read_all(Range& values) {
    uint64_t count = 0;
    read(count);
    constexpr size_t kSize = sizeof(*values.data());
    if (!ok_ || count > left_ / kSize) {
      ok_ = false;
      return;
    }
    values.resize(static_cast<size_t>(count));
    take(values.size() * kSize);
    if (!values.empty()) {
      std::memcpy(static_cast<void*>(values.data()), data_ - values.size() * kSize,
                  values.size() * kSize);
    }
  }
  // To be called with what must hold of the values that were read: ok() is false where it does not.
  void demand(bool condition) { ok_ = ok_ && condition; }
  bool ok() const { return ok_; }
  size_t left() const { return left_; }
  bool at_end() const { return ok_ && left_ == 0; }

 private:
  bool take(size_t size) {
    ok_ = ok_ && size <= left_;
    if (!ok_) return false;
    data_ += size;
    left_ -= size;
    return true;
  }
  const uint8_t* data_;
  size_t left_;
  bool ok_ = true;
};

}  // namespace plc
